"""A training on a few pictures: it goes on where it stopped, and OpenCV runs what it writes."""

import json

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
pytest.importorskip("onnx", reason="onnx is in the extra `learn`")
pytestmark = pytest.mark.filterwarnings("ignore")  # torch says that its exporter is the old one

from caretree.learning.vision.calibration import logistic
from caretree.learning.vision.dataset import DatasetSpec, load_dataset, make_dataset
from caretree.learning.vision.export import export
from caretree.learning.vision.labels import KEY_POINTS, SHOWN
from caretree.learning.vision.network import OUTPUTS, SeeingNetwork
from caretree.learning.vision.objective import _MIRRORED, Seeing, _heat
from caretree.learning.vision.train import train
from caretree.perception.learned.onnx_record import read_properties

from .still_room import still_state


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("pictures")
    return make_dataset(place, [still_state("hung"), still_state("laid")], "s", DatasetSpec(part="train", pictures=24))


def test_opencv_gives_what_torch_gives(tmp_path):
    import cv2

    torch.manual_seed(1)
    network = SeeingNetwork().eval()
    path = export(network, tmp_path / "n.onnx", {"seed": 1}, {"temperature": 1.5})
    image = np.random.default_rng(0).uniform(0, 2, (1, 5, 192, 256)).astype(np.float32)
    with torch.no_grad():
        wanted = network(torch.from_numpy(image))
    net = cv2.dnn.readNetFromONNX(str(path))
    net.setInput(image)
    for found, want in zip(net.forward(OUTPUTS), wanted, strict=True):
        assert np.abs(found - want.numpy()).max() < 1e-3
    assert path.stat().st_size < 4e6
    about = read_properties(path)
    assert json.loads(about["record"]) == {"seed": 1}
    assert json.loads(about["key_points"]) == list(KEY_POINTS)


def test_a_training_that_was_interrupted_ends_the_same(folder, tmp_path):
    whole = train(folder, tmp_path / "whole", steps=2, seed=3, say=lambda _: None)
    said = []
    assert train(folder, tmp_path / "whole", steps=2, seed=3, say=said.append) == whole
    assert not any("step" in line for line in said), "it trained again what was done"
    record = json.loads(read_properties(whole)["record"])
    assert record["data"] == load_dataset(folder)[1]
    assert {"seed", "steps", "machine", "processor_seconds"} <= set(record)


def test_the_loss_falls_on_one_batch(folder):
    objective = Seeing(load_dataset(folder)[0], 0)
    optimiser = torch.optim.Adam(objective.network.parameters(), lr=2e-3)
    losses = []
    for _ in range(12):
        loss = objective.loss(np.random.default_rng(1))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(float(loss.detach()))
    assert losses[-1] < 0.85 * losses[0]


def test_mirrored_names_are_the_other_side():
    assert KEY_POINTS[_MIRRORED[KEY_POINTS.index("corner_left")]] == "corner_right"
    assert KEY_POINTS[_MIRRORED[KEY_POINTS.index("hook")]] == "hook"


def test_heat_peaks_at_the_point():
    points = np.zeros((len(KEY_POINTS), 3), np.float32)
    points[0] = (4 * 10 + 1.5, 4 * 20 + 1.5, 1.0)
    seen = np.zeros(len(KEY_POINTS), np.uint8)
    seen[0] = SHOWN
    heat = _heat(points, seen)
    assert heat[0, 20, 10] == heat.max() == 1.0
    assert heat[1:].max() == 0.0


def test_logistic_finds_scale_and_shift():
    rng = np.random.default_rng(0)
    score = rng.normal(0, 2, 4000)
    right = rng.random(4000) < 1 / (1 + np.exp(-(0.7 * score - 0.4)))
    scale, shift = logistic(score, right.astype(float))
    assert abs(scale - 0.7) < 0.08
    assert abs(shift + 0.4) < 0.1

"""A training on a few pictures: it goes on where it stopped, and OpenCV runs what it writes."""

import hashlib
import json

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
pytest.importorskip("onnx", reason="onnx is in the extra `learn`")
pytestmark = pytest.mark.filterwarnings("ignore")  # torch says that its exporter is the old one

from caretree.learning.vision.calibration import logistic, peak_score
from caretree.learning.vision.cli import main
from caretree.learning.vision.dataset import CELL, SIZE, DatasetSpec, load_dataset, make_dataset
from caretree.learning.vision.export import export
from caretree.learning.vision.labels import ABSENT, HIDDEN, KEY_POINTS, SHOWN
from caretree.learning.vision.network import OUTPUTS, SeeingNetwork
from caretree.learning.vision.objective import _MIRRORED, Seeing, _cut_out, _heat, _peak_loss, _sheet_loss
from caretree.learning.vision.sheet_nodes import node_weights
from caretree.learning.vision.train import _begin_with, train
from caretree.sim.errors import CaretreeError
from caretree.sim.onnx_record import read_properties

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
    image = np.random.default_rng(0).uniform(0, 2, (1, 8, 192, 256)).astype(np.float32)
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
    whole = train([folder], tmp_path / "whole", steps=2, seed=3, say=lambda _: None)
    said = []
    assert train([folder], tmp_path / "whole", steps=2, seed=3, say=said.append) == whole
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


def heat_of(name, how, depth, deep=1.0):
    points = np.zeros((len(KEY_POINTS), 3), np.float32)
    points[KEY_POINTS.index(name)] = (4 * 10 + 1.5, 4 * 20 + 1.5, deep)
    seen = np.zeros(len(KEY_POINTS), np.uint8)
    seen[KEY_POINTS.index(name)] = how
    return _heat(points, seen, np.full((192, 256), depth, np.float32))


def test_heat_peaks_at_the_point():
    heat, asked = heat_of("corner_left", SHOWN, 1.0)
    assert heat[0].argmax() == 20 * 64 + 10
    assert abs(heat[0].sum() - 1.0) < 1e-5
    assert heat[1:].max() == 0.0
    assert asked.all()


def test_a_joint_is_wanted_under_cloth_and_not_asked_for_behind_a_room():
    elbow = KEY_POINTS.index("elbow_left")
    covered, asked = heat_of("elbow_left", HIDDEN, 0.9)
    assert covered[elbow].sum() > 0.99
    assert asked[elbow] == 1
    behind, asked = heat_of("elbow_left", HIDDEN, 0.3)
    assert behind.max() == 0.0
    assert asked[elbow] == 0
    hidden, asked = heat_of("corner_left", HIDDEN, 0.9)
    assert hidden.max() == 0.0
    assert asked.all()


def test_the_loss_of_a_peak_is_least_at_the_right_cell_and_at_nowhere():
    goal = torch.zeros(1, 2, 48, 64)
    goal[0, 0, 20, 10] = 1.0  # the second one is nowhere
    asked = torch.ones(1, 2)
    losses = []
    for first, second in (((20, 10), None), ((21, 10), None), ((20, 10), (5, 5))):
        heat = torch.full((1, 2, 48, 64), -20.0)
        heat[(0, 0, *first)] = 9.0
        if second:
            heat[(0, 1, *second)] = 9.0
        losses.append(float(_peak_loss(heat, goal, asked)))
    assert losses[0] < 1e-3
    assert min(losses[1:]) > 4.0
    assert float(_peak_loss(heat, goal, torch.tensor([[1.0, 0.0]]))) < 1e-3


def test_the_loss_of_the_sheet_asks_nothing_beside_the_gown():
    places = np.full((3, 2, 2), np.nan)
    places[:, 0, 0] = (0.2, 0.0, -0.5)
    goal = torch.from_numpy(np.concatenate(node_weights(places)))[None]
    assert float(_sheet_loss(30.0 * goal, goal)) < 1e-3
    wrong = 30.0 * goal.roll(1, dims=1)
    assert float(_sheet_loss(wrong, goal)) > 10.0
    assert float(_sheet_loss(wrong, torch.zeros_like(goal))) == 0.0


def test_a_training_takes_more_than_one_dataset(folder, tmp_path):
    path = train([folder, folder], tmp_path / "both", steps=1, seed=3, say=lambda _: None)
    record = json.loads(read_properties(path)["record"])
    digest = load_dataset(folder)[1]
    assert (record["data"], record["pictures"]) == (f"{digest} {digest}", 44)


def test_pictures_apart_leave_all_others_for_the_training(folder, tmp_path):
    path = train([folder], tmp_path / "t", steps=1, seed=3, say=lambda _: None, apart=folder, learning_rate=1e-4)
    record = json.loads(read_properties(path)["record"])
    assert (record["pictures"], record["apart"], record["learning_rate"]) == (24, load_dataset(folder)[1], 1e-4)


def test_a_rate_of_learning_that_is_none_is_told():
    with pytest.raises(CaretreeError, match="'2' is no rate of learning"):
        main(["train", "data", "--out", "out", "--rate", "2"])


def test_a_training_begins_with_what_fits_of_another(folder, tmp_path):
    first = train([folder], tmp_path / "first", steps=2, seed=3, say=lambda _: None)
    second = train([folder], tmp_path / "second", steps=1, seed=4, say=lambda _: None, start=first)
    start = json.loads(read_properties(second)["record"])["start"]
    # two steps: after one, weights that are still all the same are kept only once
    digest, data = hashlib.sha256(first.read_bytes()).hexdigest()[:16], load_dataset(folder)[1]
    count = len(SeeingNetwork().state_dict())
    assert start == f"{count} of {count} weights of {digest}, step 2 of a training with data {data}"
    network = SeeingNetwork()
    _begin_with(network, first)
    trained = torch.load(tmp_path / "first" / "checkpoint.pt", weights_only=True)["network"]
    assert all(torch.allclose(w, trained[name], rtol=1e-3, atol=1e-4) for name, w in network.state_dict().items())


def test_a_training_begins_with_a_network_that_was_told_less(tmp_path):
    old, new = SeeingNetwork(), SeeingNetwork()
    weights = old.state_dict()
    weights["stem.weight"] = weights["stem.weight"][:, :6]
    (tmp_path / "old").mkdir()
    state = {"network": weights, "done": 5, "identity": {"data": "d"}}
    torch.save(state, tmp_path / "old" / "checkpoint.pt")
    assert _begin_with(new, tmp_path / "old").startswith(f"{len(weights)} of {len(weights)} weights")
    stem = new.state_dict()["stem.weight"]
    assert torch.equal(stem[:, :6], weights["stem.weight"])
    assert not stem[:, 6:].any()


def test_the_mean_of_a_training_and_what_it_began_with_is_written(folder, tmp_path):
    first = train([folder], tmp_path / "first", steps=1, seed=3, say=lambda _: None)
    mean = train([folder], tmp_path / "then", steps=1, seed=4, say=lambda _: None, start=first, mean_with=first)
    before, after, written = SeeingNetwork(), SeeingNetwork(), SeeingNetwork()
    _begin_with(before, first)
    _begin_with(after, tmp_path / "then")  # the checkpoint keeps what was trained
    _begin_with(written, mean)
    for one, other, both in zip(before.parameters(), after.parameters(), written.parameters(), strict=True):
        assert torch.allclose((one + other) / 2, both, rtol=2e-3, atol=1e-4)
    assert "mean_with" in json.loads(read_properties(mean)["record"])


def test_a_training_cannot_begin_with_nothing(tmp_path):
    with pytest.raises(CaretreeError, match="no training to begin with"):
        _begin_with(SeeingNetwork(), tmp_path)
    with pytest.raises(CaretreeError, match="no training to begin with"):
        _begin_with(SeeingNetwork(), tmp_path / "none.onnx")


def test_a_peak_s_score_is_its_log_odds():
    heat = np.full((48, 64), -40.0)
    heat[20, 10] = 2.0
    assert abs(peak_score(heat, 20, 10) - 2.0) < 1e-6
    heat[40, 40] = 2.0  # elsewhere, as likely
    assert peak_score(heat, 20, 10) < 0.0


def test_logistic_finds_scale_and_shift():
    rng = np.random.default_rng(0)
    score = rng.normal(0, 2, 4000)
    right = rng.random(4000) < 1 / (1 + np.exp(-(0.7 * score - 0.4)))
    scale, shift = logistic(score, right.astype(float))
    assert abs(scale - 0.7) < 0.08
    assert abs(shift + 0.4) < 0.1


def test_what_is_cut_out_keeps_pixels_places_and_key_points_together() -> None:
    """A picture in which every pixel and cell says where it was: key points inside are where they were."""
    rng = np.random.default_rng(0)
    across = np.tile(np.arange(SIZE[0], dtype=np.float32), (SIZE[1], 1))
    image = np.repeat(across[None], 8, 0)
    middles = np.tile(np.arange(SIZE[0] // CELL, dtype=np.float32) * CELL + CELL // 2, (SIZE[1] // CELL, 1))
    points = np.column_stack([rng.uniform(0, SIZE[0] - 1, 40), rng.uniform(0, SIZE[1] - 1, 40), np.ones(40)])
    seen = np.full(40, SHOWN, np.uint8)
    lost = 0
    for _ in range(20):
        cut, surface, sheet, there, still = _cut_out(
            image, across.astype(np.int64), np.stack([middles] * 2), points, seen, rng
        )
        assert cut.shape == image.shape
        assert surface.shape == across.shape
        assert sheet.shape == (2, *middles.shape)
        lost += int((still == ABSENT).sum())
        for before, (u, v, deep) in zip(points[still == SHOWN], there[still == SHOWN], strict=True):
            column, row = min(round(u), SIZE[0] - 1), min(round(v), SIZE[1] - 1)
            assert abs(cut[3, row, column] - before[0]) <= 1.5
            assert surface[row, column] == cut[3, row, column]
            assert abs(sheet[0, row // CELL, column // CELL] - before[0]) <= 1.5 * CELL
            assert deep == 1.0
    assert 0 < lost < 20 * 40

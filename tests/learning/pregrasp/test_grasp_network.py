"""What fingers take is learned from attempts and their mirror images, and OpenCV tells what PyTorch does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
pytest.importorskip("onnx", reason="onnx is in the extra `learn`")
pytestmark = pytest.mark.filterwarnings("ignore")  # torch says that its exporter is the old one

from caretree.learning.pregrasp.export import export, export_grasps  # noqa: E402 - after the check for torch
from caretree.learning.pregrasp.grasp_network import GraspNetwork, Grasps, train_grasps  # noqa: E402
from caretree.learning.pregrasp.hung_state import hang  # noqa: E402
from caretree.learning.pregrasp.network import PolicyNetwork  # noqa: E402
from caretree.learning.pregrasp.photograph import photograph  # noqa: E402
from caretree.sim.pregrasp.policy import GRASPS, Policy  # noqa: E402
from caretree.sim.pregrasp.surroundings import CELLS, surroundings  # noqa: E402


def told(network: GraspNetwork, corners: np.ndarray) -> np.ndarray:
    """(n, 3) logits without any cloth around."""
    cells = np.zeros((len(corners), CELLS.up, CELLS.along, CELLS.across), np.float32)
    with torch.no_grad():
        return network(torch.from_numpy(cells), torch.from_numpy(corners.astype(np.float32))).numpy()


def test_an_attempt_teaches_its_mirror_image() -> None:
    rng = np.random.default_rng(0)
    corners = rng.uniform(-0.06, 0.06, (400, 3)).astype(np.float32)
    cells = np.zeros((400, CELLS.up, CELLS.along, CELLS.across), np.float32)
    right = np.full(400, 2)  # only moves to the right are tried, which win a corner to the right
    network = train_grasps(Grasps(cells, corners, right, corners[:, 1] > 0), 250, 0)
    logits = told(network, np.array(((0.0, 0.04, 0.0), (0.0, -0.04, 0.0))))
    assert logits[0, 2] > 1.0 > -1.0 > logits[1, 2]
    assert logits[1, 0] > 1.0 > -1.0 > logits[0, 0]


def test_opencv_tells_what_pytorch_does(tmp_path: Path) -> None:
    torch.manual_seed(1)
    network = GraspNetwork().eval()
    export(PolicyNetwork(), tmp_path / "pregrasp.onnx", {"seed": 1})
    export_grasps(network, tmp_path / GRASPS, {"seed": 1}, (2.0, 1.0))
    policy, views = Policy(tmp_path / "pregrasp.onnx"), photograph(hang(104))
    values = policy.values(views)
    places, spots = views.places()
    near = spots[np.linalg.norm(places - policy.corner(views), axis=1) < CELLS.reach]
    assert len(near) > 10
    cells, corners = surroundings(views, policy.corner(views), near)
    with torch.no_grad():
        wanted = network(torch.from_numpy(cells), torch.from_numpy(corners)).numpy()
        corners[:, 1] *= -1.0
        mirrored = network(torch.from_numpy(cells[..., ::-1].copy()), torch.from_numpy(corners)).numpy()
    view, row, column = near.T
    assert np.allclose(values[view, :, row, column], (wanted + mirrored[:, ::-1]) / 2, atol=1e-4)
    assert np.isfinite(values).sum() == 3 * len(near)
    assert policy.confidence(0.0) == pytest.approx(1 / (1 + np.exp(-1.0)))
    assert policy.confidence(-1e9) < 1e-9

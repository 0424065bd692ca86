"""The policy learns what it is shown, goes on where it stopped, and OpenCV runs it as PyTorch does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
pytest.importorskip("onnx", reason="onnx is in the extra `learn`")
pytestmark = pytest.mark.filterwarnings("ignore")  # torch says that its exporter is the old one

from caretree.learning.pregrasp import dataset  # noqa: E402 - after the check for torch
from caretree.learning.pregrasp import train as training_file  # noqa: E402
from caretree.learning.pregrasp.oracle import Attempt  # noqa: E402
from caretree.learning.pregrasp.train import Plan, Training, train  # noqa: E402
from caretree.sim.errors import CaretreeError  # noqa: E402
from caretree.sim.pregrasp.action import Action  # noqa: E402
from caretree.sim.pregrasp.affordance import seen  # noqa: E402
from caretree.sim.pregrasp.policy import Policy  # noqa: E402


def right_of_the_middle(state: object, views: dataset.Views, pixels: int) -> list[Attempt]:
    """Success of the move to the right at one pixel of view 2, and of nothing else."""
    spots = np.argwhere(views.depth[2] > 0)
    row, column = (int(k) for k in spots[len(spots) // 2])
    return [
        Attempt(action=Action(primitive=p, view=2, row=row, column=column), pixel=0, layers=1, corner=p == 2)
        for p in range(3)
    ]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(dataset, "try_all", right_of_the_middle)
    return dataset.make_dataset(tmp_path / "data", range(110, 112))


def test_it_learns_which_primitive_succeeds(folder: Path) -> None:
    training = Training(dataset.load_dataset(folder), Plan(steps=1, trials=0))
    first = training.step()
    losses = [training.step() for _ in range(25)]
    assert np.mean(losses[-5:]) < 0.8 * first


def test_it_learns_from_values_that_have_died(folder: Path) -> None:
    training = Training(dataset.load_dataset(folder), Plan(steps=1, trials=0))
    assert training.network.heads.bias is not None
    torch.nn.init.constant_(training.network.heads.bias, -200.0)  # a sigmoid of 0, with a slope of 0
    first = training.step()
    assert np.mean([training.step() for _ in range(5)]) < first


def test_it_goes_on_where_it_stopped_and_runs_without_torch(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(training_file, "SAVE", 2)
    plan, out = Plan(steps=4, grasp_steps=3, trials=4), folder.parent / "out"
    path = train(folder, folder.parent / "whole", plan)
    step, calls = Training.step, []

    def interrupted(self: Training) -> float:
        calls.append(1)
        if len(calls) == 4:
            raise KeyboardInterrupt
        return step(self)

    with monkeypatch.context() as patch:
        patch.setattr(Training, "step", interrupted)
        with pytest.raises(KeyboardInterrupt):
            train(folder, out, plan)
    views = dataset.load_dataset(folder).views(0)
    values = Policy(train(folder, out, plan)).maps(views)
    assert np.allclose(values, Policy(path).maps(views), atol=1e-5)
    assert Policy(path).record["seed"] == 0
    network = Training(dataset.load_dataset(folder), plan).network
    network.load_state_dict(torch.load(out / "checkpoint.pt", weights_only=True)["network"])
    with torch.no_grad():
        assert np.allclose(network(torch.from_numpy(seen(views))).numpy(), values, atol=1e-4)
    assert path.stat().st_size < 2e6
    with pytest.raises(CaretreeError, match="another training"):
        train(folder, out, Plan(steps=5, grasp_steps=3, trials=4))


def test_a_policy_of_direct_grasps_alone_never_sweeps(folder: Path) -> None:
    views = dataset.load_dataset(folder).views(0)
    for grasp_only, known in ((False, [True, True, True]), (True, [False, True, False])):
        plan = Plan(steps=1, grasp_steps=1, trials=0, grasp_only=grasp_only)
        values = Policy(train(folder, folder.parent / f"out {grasp_only}", plan)).values(views)
        assert np.isfinite(values).any((0, 2, 3)).tolist() == known


def test_nothing_to_train_on_is_refused(folder: Path) -> None:
    with pytest.raises(CaretreeError, match="nothing to train on"):
        train(folder, folder.parent / "none", Plan(steps=0, trials=0))


def test_a_broken_policy_is_refused(tmp_path: Path) -> None:
    (tmp_path / "pregrasp.onnx").write_bytes(b"no")
    with pytest.raises(CaretreeError, match="no pre-grasp policy"):
        Policy(tmp_path / "pregrasp.onnx")

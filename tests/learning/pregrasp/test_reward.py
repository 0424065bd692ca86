"""What the pictures show after an action tells its reward, and the trials of a policy can learn from that."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from caretree.learning.pregrasp import dataset
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.oracle import choices
from caretree.learning.pregrasp.photograph import photograph
from caretree.learning.pregrasp.rate import area_under_curve
from caretree.learning.pregrasp.roll_out import roll_out
from caretree.perception.learned.pre_grasp_policy import PACKAGED
from caretree.sim.errors import CaretreeError
from caretree.sim.pregrasp.action import hand_path
from caretree.sim.pregrasp.numbers import DIRECT
from caretree.sim.pregrasp.reward import RewardClassifier


def test_the_hand_hides_what_it_holds() -> None:
    state = hang(104)
    views = photograph(state)
    at_corner = [action for pixel, action in choices(state, views) if (pixel, action.primitive) == (0, DIRECT)]
    grasp = roll_out(state, hand_path(views, at_corner[0]))
    assert grasp.success
    moved = replace(state, vertices=grasp.vertices)
    alone, with_hand = (photograph(moved, hand=hand).places()[0] for hand in (None, grasp.hand))
    near = [int((np.linalg.norm(cloud - grasp.hand[:3, 3], axis=1) < 0.05).sum()) for cloud in (alone, with_hand)]
    assert near[1] < 0.8 * near[0]


def test_area_under_the_curve_counts_pairs() -> None:
    told, won = np.array((0.1, 0.4, 0.4, 0.9)), np.array((False, False, True, True))
    assert area_under_curve(told, won)[0] == pytest.approx(3.5 / 4)
    assert area_under_curve(-told, won)[0] == pytest.approx(0.5 / 4)
    rng = np.random.default_rng(0)
    won = rng.random(400) < 0.3
    area, low, high = area_under_curve(won + rng.normal(0.0, 1.0, 400), won)
    assert low < area < high < low + 0.2


def test_a_file_that_is_no_network_of_rewards_is_refused(tmp_path: Path) -> None:
    (tmp_path / "no.onnx").write_bytes(b"no")
    for path in (tmp_path / "no.onnx", tmp_path / "none.onnx", PACKAGED):
        with pytest.raises(CaretreeError, match="this is no network of rewards"):
            RewardClassifier(path)


class TestTrained:
    """What needs PyTorch."""

    @pytest.fixture
    def folders(self, tmp_path: Path) -> tuple[Path, Path]:
        pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
        pytest.importorskip("onnx", reason="onnx is in the extra `learn`")
        seeds = (range(110, 112), range(112, 113))
        return tuple(dataset.make_dataset(tmp_path / str(s[0]), s, oracle="drawn") for s in seeds)  # type: ignore[return-value]

    @pytest.mark.filterwarnings("ignore")  # torch says that its exporter is the old one
    def test_it_is_trained_tested_and_told_by_opencv(self, folders: tuple[Path, Path], tmp_path: Path) -> None:
        import torch
        from caretree.learning.pregrasp.export import export_reward
        from caretree.learning.pregrasp.reward import RewardNetwork, make_reward, outcomes_of, train_reward

        seen = outcomes_of(dataset.load_dataset(folders[0]))
        assert np.array_equal(seen.won, dataset.load_dataset(folders[0]).success)  # the same attempts, once more
        assert seen.won.any()
        network = train_reward(seen, 150, 0)
        with torch.no_grad():
            told = network(torch.from_numpy(seen.cells))[:, 0].numpy()
        assert area_under_curve(told, seen.won)[0] > 0.9  # of what it was trained on
        told_again = RewardClassifier(export_reward(network, tmp_path / "one.onnx", {"seed": 0}))._told(seen.cells[0])
        assert told_again == pytest.approx(float(told[0]), abs=1e-4)
        assert isinstance(RewardNetwork(), torch.nn.Module)
        text = make_reward(*folders, tmp_path / "reward.onnx", steps=2, seed=0)
        assert "16 attempts in 1 states" in text
        assert RewardClassifier(tmp_path / "reward.onnx").record["steps"] == 2
        with pytest.raises(CaretreeError, match="on others"):
            make_reward(folders[0], folders[0], tmp_path / "x.onnx", steps=1, seed=0)

    @pytest.mark.filterwarnings("ignore")
    def test_trials_learn_what_the_reward_says(
        self, folders: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        from caretree.learning.pregrasp.export import export_reward
        from caretree.learning.pregrasp.reward import RewardNetwork
        from caretree.learning.pregrasp.train import Plan, Training

        classifier = RewardClassifier(export_reward(RewardNetwork(), tmp_path / "r.onnx", {}))
        monkeypatch.setattr(classifier, "chance", lambda *_: 0.9)
        training = Training(dataset.load_dataset(folders[0]), Plan(steps=0, trials=2), classifier)
        truth = [training.trial() for _ in range(2)]
        assert training.curve == [int(won) for won in truth]
        assert [bool(one.won[0]) for one in training.felt] == [True, True]
        assert [rows[0][-1] for rows in training.tried] == [1, 1]

"""A policy is tried in either engine, by the action of its highest value."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from caretree.learning.pregrasp import ceiling, dataset, evaluate
from caretree.learning.pregrasp.cli import main
from caretree.learning.pregrasp.evaluate import ENGINES, policy_wins
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.numbers import PRIMITIVES
from caretree.learning.pregrasp.oracle import corner_pixel
from caretree.sim.errors import CaretreeError

SEED = 104
VIEW = 0  # from which a direct grasp at the pixel of the corner succeeds in this state


class Told:
    """A policy that is told where to grasp."""

    def __init__(self, pixel: tuple[int, int]) -> None:
        self.pixel = pixel

    def values(self, image: np.ndarray) -> np.ndarray:
        values = np.zeros((len(image), len(PRIMITIVES), *image.shape[2:]))
        row, column = self.pixel
        values[VIEW, PRIMITIVES.index("direct"), row, column] = 1.0
        return values


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dataset.Dataset:
    monkeypatch.setattr(dataset, "try_all", lambda *_: [])
    assert main(["data", str(tmp_path / "a"), "--seeds", str(SEED)]) == 0
    return dataset.load_dataset(tmp_path / "a")


@pytest.mark.parametrize("engine", ENGINES)
def test_the_corner_is_won_and_the_edge_of_the_gown_is_not(data: dataset.Dataset, engine: str) -> None:
    views = data.views(0)
    corner = corner_pixel(hang(SEED, str(data.gowns[0])), views, VIEW)
    assert corner is not None
    highest = tuple(int(k) for k in np.argwhere(views.depth[VIEW] > 0)[0])  # at the hand that holds the gown
    assert policy_wins(data, Told(corner), engine=engine).tolist() == [[True], [True]]
    assert policy_wins(data, Told(highest), engine=engine).tolist() == [[False], [False]]


def test_deep_grasps_are_not_tried_in_pybullet(data: dataset.Dataset) -> None:
    with pytest.raises(CaretreeError, match="meet itself"):
        policy_wins(replace(data, deep=True), Told((0, 0)), engine="bullet")


@pytest.mark.parametrize("engine", ENGINES)
def test_the_command_tries_the_policy_in_the_engine_it_is_told(
    data: dataset.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, engine: str
) -> None:
    tried: list[str] = []
    monkeypatch.setattr(ceiling, "table", lambda _: "")  # of no attempts there is none
    monkeypatch.setattr(evaluate, "policy_table", lambda *_, engine: tried.append(engine) or "")
    assert main(["evaluate", str(tmp_path / "a"), "--policy", "any.onnx", "--engine", engine]) == 0
    assert tried == [engine]

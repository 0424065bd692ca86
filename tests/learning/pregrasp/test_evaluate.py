"""A policy is tried in either engine, by the action of its highest value."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from caretree.learning.pregrasp import ceiling, dataset, evaluate
from caretree.learning.pregrasp.calibration import calibration_error, fit_chance
from caretree.learning.pregrasp.cli import main
from caretree.learning.pregrasp.evaluate import ENGINES, Tried, try_policy
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.oracle import corner_pixel
from caretree.sim.errors import CaretreeError
from caretree.sim.pregrasp.numbers import DIRECT, PRIMITIVES
from caretree.sim.pregrasp.views import Views

SEED = 104
VIEW = 0  # from which a direct grasp at the pixel of the corner succeeds in this state


class Told:
    """A policy that is told where to grasp."""

    def __init__(self, pixel: tuple[int, int]) -> None:
        self.pixel = pixel

    def values(self, views: Views) -> np.ndarray:
        values = np.zeros((len(views.depth), len(PRIMITIVES), *views.depth.shape[1:]))
        row, column = self.pixel
        values[VIEW, PRIMITIVES.index("direct"), row, column] = 1.0
        return values


class Named:
    """A policy of which only the name of its file counts."""

    def __init__(self, path: Path) -> None:
        self.name = path.name

    def confidence(self, _: float) -> float:
        return 0.5


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
    for pixel, succeeds in ((corner, True), (highest, False)):
        found = try_policy(data, Told(pixel), engine=engine)
        assert (found.best.tolist(), found.direct.tolist()) == ([succeeds], [succeeds])
        assert (found.value.tolist(), found.primitive.tolist()) == ([1.0], [DIRECT])


def test_deep_grasps_are_not_tried_in_pybullet(data: dataset.Dataset) -> None:
    with pytest.raises(CaretreeError, match="meet itself"):
        try_policy(replace(data, deep=True), Told((0, 0)), engine="bullet")


@pytest.mark.parametrize("engine", ENGINES)
def test_the_command_tries_the_policy_in_the_engine_it_is_told(
    data: dataset.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, engine: str
) -> None:
    tried: list[str] = []
    monkeypatch.setattr(ceiling, "table", lambda _: "")  # of no attempts there is none
    monkeypatch.setattr(evaluate, "policy_table", lambda *_, engine, against: tried.append(engine) or "")
    assert main(["evaluate", str(tmp_path / "a"), "--policy", "any.onnx", "--engine", engine]) == 0
    assert tried == [engine]


def test_two_policies_are_compared_in_the_same_states(
    data: dataset.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    won = {"one.onnx": np.array([True]), "other.onnx": np.array([False])}

    def told(_: object, policy: Named, *__: object, **___: object) -> Tried:
        best = won[policy.name]
        return Tried(best=best, direct=best, value=np.zeros(1), primitive=np.full(1, DIRECT))

    monkeypatch.setattr(evaluate, "Policy", Named)
    monkeypatch.setattr(evaluate, "try_policy", told)
    everything = replace(data, oracle="none")
    assert "against" not in evaluate.policy_table(everything, Path("one.onnx"))
    text = evaluate.policy_table(everything, Path("one.onnx"), against=Path("other.onnx"))
    assert "| against it, other.onnx | 0/1" in text
    assert "Of all states it wins 1 that other.onnx loses, and loses 0 (sign test p = 1)." in text
    with pytest.raises(CaretreeError, match="name the other one with --policy"):
        main(["evaluate", str(tmp_path / "a"), "--against", "other.onnx"])


def test_one_action_is_carried_out_once(data: dataset.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[object] = []
    monkeypatch.setattr(evaluate, "_succeeds", lambda *what: bool(tried.append(what)))
    try_policy(data, Told(int(k) for k in np.argwhere(data.views(0).depth[VIEW] > 0)[0]))
    assert len(tried) == 1


def test_chances_are_fitted_and_their_error_told() -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(0.0, 3.0, 4000)
    won = rng.random(4000) < 1.0 / (1.0 + np.exp(-(0.5 * values + 1.0)))
    assert fit_chance(values, won) == (pytest.approx(0.5, abs=0.05), pytest.approx(1.0, abs=0.1))
    assert calibration_error(np.full(4, 0.75), np.array([1, 1, 1, 0], bool)) == pytest.approx(0.0)
    assert calibration_error(np.array([0.95, 0.95, 0.15]), np.array([1, 0, 1], bool)) == pytest.approx((0.9 + 0.85) / 3)

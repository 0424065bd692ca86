"""Datasets of pre-grasps: the same seeds give the same bytes, what is there is kept, damage is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from caretree.learning.pregrasp import dataset, oracle
from caretree.learning.pregrasp.agreement import paired
from caretree.learning.pregrasp.ceiling import ceiling, table
from caretree.learning.pregrasp.cli import main
from caretree.learning.pregrasp.gowns import STIFFEST, gown_of
from caretree.learning.pregrasp.hung_state import hang
from caretree.learning.pregrasp.numbers import PHYSICS
from caretree.learning.pregrasp.oracle import Attempt
from caretree.learning.pregrasp.photograph import photograph
from caretree.sim.errors import CaretreeError
from caretree.sim.pregrasp.action import Action
from caretree.sim.pregrasp.numbers import DIRECT
from caretree.sim.scene.gown import GOWNS


def few(state: object, views: dataset.Views, pixels: int) -> list[Attempt]:
    """Two attempts instead of ninety: a direct grasp that fails and a sweep that succeeds."""
    row, column = (int(k) for k in np.argwhere(views.depth[0] > 0)[0])
    return [
        Attempt(action=Action(primitive=p, view=0, row=row, column=column), pixel=0, layers=1, corner=p == 2)
        for p in (1, 2)
    ]


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(dataset, "try_all", few)
    monkeypatch.setattr(dataset, "SHARD", 2)
    assert main(["data", str(tmp_path / "a"), "--seeds", "110-112"]) == 0
    return tmp_path / "a"


def test_same_seeds_same_bytes_and_what_is_there_is_kept(made: Path) -> None:
    before = {p.name: p.read_bytes() for p in made.iterdir()}
    (made / "shard_0000.npz").unlink()
    kept = (made / "dataset.json").stat().st_mtime_ns
    assert main(["data", str(made), "--seeds", "110-112"]) == 0
    assert {p.name: p.read_bytes() for p in made.iterdir()} == before
    assert (made / "dataset.json").stat().st_mtime_ns > kept


def test_ceiling_counts_states_that_only_sweeps_win(made: Path) -> None:
    data = dataset.load_dataset(made)
    found = ceiling(data)
    assert len(data.seeds) == 3
    assert found.hard.all()
    assert found.primitives.all()
    assert not found.direct_pixels.any()
    assert "Sweeps win 3 states" in table(data)


def test_other_states_and_damaged_shards_are_refused(made: Path) -> None:
    with pytest.raises(CaretreeError, match="choose another folder"):
        main(["data", str(made), "--seeds", "111-112"])
    (made / "shard_0001.npz").write_bytes(b"no")
    with pytest.raises(CaretreeError, match="not the one that"):
        main(["evaluate", str(made)])
    with pytest.raises(CaretreeError, match="no dataset of pre-grasps"):
        main(["evaluate", str(made.parent)])


def test_kept_seeds_are_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.raises((SystemExit, CaretreeError)):
        main(["data", str(tmp_path / "x"), "--seeds", "8999-9000"])
    assert not (tmp_path / "x").exists()


def test_deep_grasps_are_told_apart_and_not_repeated_in_pybullet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dataset, "try_all", few)
    assert main(["data", str(tmp_path / "a"), "--seeds", "110", "--deep", "--pixels", "1"]) == 0
    data = dataset.load_dataset(tmp_path / "a")
    assert data.deep
    with pytest.raises(CaretreeError, match="meet itself"):
        paired(data, 2, 0)
    with pytest.raises(CaretreeError, match="deep True, pixels 1, not with deep False, pixels 5"):
        main(["data", str(tmp_path / "a"), "--seeds", "110"])


def tells(wins: set[tuple[bool, bool]], tried: list[tuple[bool, bool]]) -> Callable[..., Attempt]:
    """Carries out nothing: kinds of action (direct, at the corner's pixel) that win, and what was tried."""

    def attempt(state: object, views: object, action: Action, pixel: int = -1) -> Attempt:
        tried.append(kind := (action.primitive == DIRECT, pixel == 0))
        return Attempt(action=action, pixel=pixel, layers=1, corner=kind in wins)

    return attempt


@pytest.mark.parametrize(
    ("wins", "kinds"),
    [
        ({(True, True)}, [(True, True)]),
        ({(False, True)}, [(True, True), (False, True), (True, False)]),
        ({(True, False)}, [(True, True), (False, True), (True, False)]),
        (set(), [(True, True), (False, True), (True, False), (False, False)]),
    ],
)
def test_no_more_is_tried_than_tells_the_ceilings(
    wins: set[tuple[bool, bool]], kinds: list[tuple[bool, bool]], monkeypatch: pytest.MonkeyPatch
) -> None:
    tried: list[tuple[bool, bool]] = []
    monkeypatch.setattr(oracle, "attempt", tells(wins, tried))
    state = hang(104)
    views = photograph(state)
    found = oracle.try_until(state, views)
    assert list(dict.fromkeys(tried)) == kinds
    assert [one.success for one in found].count(True) == len(wins)
    assert len(found) == len(tried)
    everything = [(action.primitive == DIRECT, pixel == 0) for pixel, action in oracle.choices(state, views)]
    assert all(tried.count(kind) == everything.count(kind) for kind in kinds if kind not in wins)


def test_what_is_drawn_lies_near_the_corner_and_is_the_same_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oracle, "attempt", tells(set(), tried := []))
    state = hang(104)
    views = photograph(state)
    found = oracle.try_drawn(state, views)
    assert found == oracle.try_drawn(state, views)
    assert tried.count((True, False)) == 2 * oracle.DRAWN == tried.count((False, False))
    for one in found:
        place = views.place(one.action.view, one.action.row, one.action.column)
        assert np.linalg.norm(place - state.vertices[state.wanted]) < oracle.NEAR


def test_what_is_drawn_tells_no_ceiling(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oracle, "attempt", tells(set(), []))
    assert main(["data", str(tmp_path / "a"), "--seeds", "110", "--oracle", "drawn"]) == 0
    data = dataset.load_dataset(tmp_path / "a")
    state = hang(110)
    assert np.allclose(data.corners[0], state.vertices[state.wanted])
    with pytest.raises(CaretreeError, match="drawn tells no ceiling"):
        ceiling(data)


def test_the_cloth_is_whose_physics_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dataset, "SHARD", 2)
    for physics in PHYSICS:
        folder = tmp_path / physics
        assert main(["data", str(folder), "--seeds", "110-111", "--physics", physics, "--oracle", "none"]) == 0
    folders = {physics: dataset.load_dataset(tmp_path / physics) for physics in PHYSICS}
    assert {name: data.physics for name, data in folders.items()} == {name: name for name in PHYSICS}
    cuts = {name: [key.split("/")[0] for key in data.gowns.tolist()] for name, data in folders.items()}
    assert all(of == cuts["identified"] for of in cuts.values())
    first = {name: gown_of(str(data.gowns[0])) for name, data in folders.items()}
    assert len({(spec.mass, spec.elastic, spec.bending) for spec in first.values()}) >= 3  # what was tuned may be true
    assert (first["true"].mass, first["true"].elastic) == (GOWNS[cuts["true"][0]].mass, GOWNS[cuts["true"][0]].elastic)
    random = [gown_of(str(key)) for key in folders["random"].gowns]
    assert random[0].mass != random[1].mass
    kept = hang(110, str(folders["random"].gowns[0]))  # as `evaluate` hangs it again
    assert np.array_equal(kept.vertices, hang(110, physics="random").vertices)


def test_random_cloth_is_none_that_the_springs_cannot_simulate() -> None:
    drawn = [gown_of(f"medium/random {k}") for k in range(200)]
    assert max(spec.elastic / spec.mass for spec in drawn) < STIFFEST
    assert min(spec.mass for spec in drawn) < 0.2 < 0.8 < max(spec.mass for spec in drawn)


def test_a_folder_of_other_cloth_is_refused(made: Path) -> None:
    with pytest.raises(CaretreeError, match="physics identified, not with physics true"):
        main(["data", str(made), "--seeds", "110-112", "--physics", "true"])

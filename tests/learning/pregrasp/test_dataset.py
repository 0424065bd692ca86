"""Datasets of pre-grasps: the same seeds give the same bytes, what is there is kept, damage is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from caretree.learning.pregrasp import dataset
from caretree.learning.pregrasp.action import Action
from caretree.learning.pregrasp.agreement import paired
from caretree.learning.pregrasp.ceiling import ceiling, table
from caretree.learning.pregrasp.cli import main
from caretree.learning.pregrasp.oracle import Attempt
from caretree.sim.errors import CaretreeError


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

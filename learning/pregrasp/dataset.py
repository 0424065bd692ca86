"""A folder of states, their pictures and what the oracle's actions came to: shards and `dataset.json`.

The same seeds give the same bytes; what is missing is made, what is there is kept.
"""

from __future__ import annotations

import hashlib
import io
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.pregrasp.views import Views
from ..shards import each_shard, replace_file, shard_name
from .hung_state import HungState, hang
from .oracle import PIXELS, Attempt, try_all, try_drawn, try_until
from .photograph import photograph

FORMAT = "caretree-pregrasp-3"  # 2: fingers meet cloth at the nearest points; deep grasps.  3: corners, oracles
INDEX = "dataset.json"
SHARD = 10  # states
COLUMNS = ("state", "pixel", "primitive", "view", "row", "column", "layers", "corner")  # of an attempt


@dataclass(frozen=True, kw_only=True)
class Dataset:
    """All of a folder.

    Attributes:
        seeds: (S,) of the states.
        gowns: (S,) their keys, see `gowns.py`.
        rgb: (S, 6, H, W, 3) uint8.
        depth: (S, 6, H, W) uint16 [mm], 0 where the gown does not show.
        corners: (S, 3) float32, where the wanted end of the neckline is, in the frame of the holding hand [m].
        attempts: (A, 8) int, `COLUMNS`; `state` is an index into the others.
        digest: of everything.
        deep: whether the states are deep grasps, see `hung_state`.
        oracle: of `ORACLES`, which actions were tried.
        physics: of `PHYSICS`, whose cloth the gowns have.
    """

    seeds: np.ndarray
    gowns: np.ndarray
    rgb: np.ndarray
    depth: np.ndarray
    corners: np.ndarray
    attempts: np.ndarray
    digest: str
    deep: bool = False
    oracle: str = "all"
    physics: str = "identified"

    @property
    def success(self) -> np.ndarray:
        """(A,) bool: a single layer, at the wanted corner."""
        return (self.attempts[:, 6] == 1) & (self.attempts[:, 7] == 1)

    @property
    def tells_ceiling(self) -> bool:
        """Whether enough was tried to tell what can be reached."""
        return self.oracle in ("all", "ceiling")

    def views(self, state: int) -> Views:
        """The pictures of a state."""
        return Views(rgb=self.rgb[state], depth=self.depth[state].astype(np.float32) / 1e3)


def row_of(state: int, one: Attempt) -> tuple[int, ...]:
    """An attempt as `COLUMNS`."""
    a = one.action
    return (state, one.pixel, a.primitive, a.view, a.row, a.column, one.layers, int(one.corner))


def make_dataset(
    folder: str | Path,
    seeds: Sequence[int],
    say: Callable[[str], None] = lambda text: None,
    *,
    gown: str | None = None,
    deep: bool = False,
    pixels: int = len(PIXELS),
    oracle: str = "all",
    physics: str = "identified",
    jobs: int | None = None,
    address: str | None = None,
) -> Path:
    """Make a dataset, or what is missing of it.

    Args:
        folder: made when it is not there.
        seeds: of the states.
        say: takes lines of progress.
        gown: of all states; None leaves it to each seed.
        deep: whether the states are deep grasps, see `hung_state`.
        pixels: that the oracle tries in a view, the first of `PIXELS`.
        oracle: of `ORACLES`, which of its actions are tried.
        physics: of `PHYSICS`, whose cloth the gowns have.
        jobs: shards made at once; more than one needs Ray.
        address: of a Ray cluster.

    Raises:
        CaretreeError: the folder holds another dataset, or Ray is asked for and not there.
    """
    folder, seeds = Path(folder), list(seeds)
    folder.mkdir(parents=True, exist_ok=True)
    about: dict[str, Any] = {"format": FORMAT, "first": seeds[0], "gown": gown, "deep": deep, "pixels": pixels} | {
        "oracle": oracle,
        "physics": physics,
    }
    old = read_index(folder) if (folder / INDEX).is_file() else {**about, "shards": []}
    if any(old[key] != about[key] for key in about):
        theirs = ", ".join(f"{key} {old[key]}" for key in about if old[key] != about[key])
        mine = ", ".join(f"{key} {about[key]}" for key in about if old[key] != about[key])
        raise CaretreeError(f"{folder} holds states with {theirs}, not with {mine}; choose another folder")
    whole = {s["file"]: s for s in old["shards"] if s["states"] == SHARD and (folder / s["file"]).is_file()}
    missing = [n for n in range(-(-len(seeds) // SHARD)) if shard_name(n) not in whole]
    what = (gown, deep, pixels, oracle, physics)
    for number, shard in each_shard(make_shard, missing, seeds, *what, jobs=jobs, address=address):
        replace_file(folder / shard_name(number), shard.pop("bytes"))
        spent = shard.pop("seconds")
        whole[shard_name(number)] = shard
        replace_file(
            folder / INDEX, (json.dumps({**about, "shards": [whole[k] for k in sorted(whole)]}, indent=1)).encode()
        )
        made = sum(s["states"] for s in whole.values())
        say(f"{made} of {len(seeds)} states, {spent:.0f} s of processor time for {shard['attempts']} attempts")
    return folder


def make_shard(
    number: int, seeds: Sequence[int], gown: str | None, deep: bool, pixels: int, oracle: str, physics: str
) -> dict[str, Any]:
    """States of one shard, tried by the oracle: `file`, `states`, `attempts`, `sha256`, `seconds`, `bytes`."""
    start, mine = time.process_time(), seeds[number * SHARD : (number + 1) * SHARD]
    rgb, depth, gowns, corners, rows = [], [], [], [], []
    for k, seed in enumerate(mine):
        state = hang(seed, gown, deep, physics=physics)
        views = photograph(state)
        rgb.append(views.rgb)
        depth.append(np.round(views.depth * 1e3).astype(np.uint16))
        gowns.append(state.gown)
        kept = Views(rgb=views.rgb, depth=depth[-1].astype(np.float32) / 1e3)  # what a reader of the folder will have
        corners.append(state.vertices[state.wanted])
        rows += [row_of(k, one) for one in _tried(state, kept, pixels, oracle)]
    buffer = io.BytesIO()
    attempts = np.array(rows, np.int16).reshape(-1, len(COLUMNS))
    np.savez_compressed(
        buffer,
        seeds=np.array(mine),
        gowns=np.array(gowns),
        rgb=np.stack(rgb),
        depth=np.stack(depth),
        corners=np.stack(corners).astype(np.float32),
        attempts=attempts,
    )
    data = buffer.getvalue()
    return {
        "file": shard_name(number),
        "states": len(mine),
        "attempts": len(rows),
        "sha256": hashlib.sha256(data).hexdigest(),
        "seconds": time.process_time() - start,
        "bytes": data,
    }


def _tried(state: HungState, views: Views, pixels: int, oracle: str) -> list[Attempt]:
    """What an oracle of `ORACLES` tries."""
    if oracle == "none":
        return []
    if oracle == "drawn":
        return try_drawn(state, views)
    return (try_until if oracle == "ceiling" else try_all)(state, views, pixels)


def read_index(folder: str | Path) -> dict[str, Any]:
    """What a dataset's folder says about it.

    Raises:
        CaretreeError: it is none.
    """
    try:
        index = json.loads((Path(folder) / INDEX).read_text(encoding="utf-8"))
        assert index["format"] == FORMAT
        index.setdefault("physics", "identified")  # of folders made before it could be another
    except (OSError, ValueError, KeyError, AssertionError) as error:
        raise CaretreeError(f"{folder}: this is no dataset of pre-grasps in format {FORMAT}") from error
    return index


def load_dataset(folder: str | Path) -> Dataset:
    """All that a folder holds.

    Raises:
        CaretreeError: it is no dataset, or a shard is damaged.
    """
    parts, before, index = [], 0, read_index(folder)
    for shard in index["shards"]:
        try:
            data = (Path(folder) / shard["file"]).read_bytes()
        except OSError as error:
            raise CaretreeError(f"{folder}/{shard['file']}: the shard is missing") from error
        if hashlib.sha256(data).hexdigest() != shard["sha256"]:
            raise CaretreeError(f"{folder}/{shard['file']}: the shard is not the one that {INDEX} names")
        with np.load(io.BytesIO(data)) as file:
            part = {key: file[key] for key in file.files}
        part["attempts"] = part["attempts"].astype(int)
        part["attempts"][:, 0] += before
        before += len(part["seeds"])
        parts.append(part)
    if not parts:
        raise CaretreeError(f"{folder}: the dataset is empty")
    digest = hashlib.sha256("".join(s["sha256"] for s in index["shards"]).encode()).hexdigest()[:16]
    joined = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    return Dataset(**joined, digest=digest, deep=index["deep"], oracle=index["oracle"], physics=index["physics"])

"""Make a dataset: shard after shard, on one core, on several, or on a Ray cluster; resumable.

A shard is written beside its place and renamed, so that what has its name is whole.  The index is written after
every shard.  After an interruption, or with a larger `per_class`, the same command goes on where it stopped.
"""

from __future__ import annotations

import hashlib
import io
import os
import platform
import sys
import time
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.errors import CaretreeError
from ...shards import each_shard, replace_file, shard_name
from .camera import misplacement, standard_camera
from .clip import packed
from .dataset import INDEX, SHARD, DatasetSpec, read_index, read_shard, write_index
from .depth_noise import disturb
from .parameters import to_spec


def make_shard(number: int, spec: DatasetSpec) -> dict[str, Any]:
    """Make the clips of one shard.

    Args:
        number: of the shard.
        spec: of the dataset.

    Returns:
        `file`, `clips`, `sha256`, `seconds` (processor time), and `bytes` of the file.
    """
    started = time.process_time()
    ids = range(number * SHARD, min((number + 1) * SHARD, spec.clips))
    units = np.array([spec.unit_of(i) for i in ids])
    depth = np.array(list(_depths(spec, ids)))
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer,
        depth=depth,
        unit=units.astype(np.float32),
        class_id=np.array([spec.class_of(i) for i in ids], np.int32),
        split=np.array([spec.split_of(i) for i in ids]),
    )
    data = buffer.getvalue()
    return {
        "file": shard_name(number),
        "clips": len(ids),
        "sha256": hashlib.sha256(data).hexdigest(),
        "seconds": round(time.process_time() - started, 2),
        "bytes": data,
    }


def _depths(spec: DatasetSpec, ids: range) -> Iterator[np.ndarray]:
    """Packed depth of each clip; a fall that is rendered several times is simulated once."""
    from .render_clip import clip_of, path_of, render_path

    camera, last, gown, path = standard_camera(), -1, None, None
    for i in ids:
        if gown is None or path is None or i // spec.views != last:
            gown, last = to_spec(spec.unit_of(i), spec.gown_of(i)), i // spec.views
            path = path_of(gown)
        depth = render_path(gown, path, camera.moved(spec.misplaced(i)) if spec.disturbed(i) else camera)
        if spec.disturbed(i):
            rng = np.random.default_rng([spec.seed_of(i), 5])
            misplacement(rng)  # the numbers that `misplaced` used
            depth = disturb(depth, rng)
        yield packed(clip_of(depth, camera).depth)


def generate(
    folder: str | Path,
    spec: DatasetSpec,
    jobs: int | None = None,
    address: str | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> Path:
    """Make a dataset, or what is missing of it.

    Args:
        folder: of the dataset; made when it is not there.
        spec: what it shall hold.
        jobs: shards made at once; more than one needs Ray.  None: one here, on a cluster as many as it has cores.
        address: of a Ray cluster; its machines need this package, not this folder.
        say: takes lines of progress.

    Returns:
        The folder.

    Raises:
        CaretreeError: the folder holds another dataset, Ray is asked for and not installed or not reached, or shards
            were lost with their workers: the others are kept.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shards = _finished(folder, spec)
    count = -(-spec.clips // SHARD)
    missing = [n for n in range(count) if n not in shards]
    started, fresh = time.monotonic(), 0
    facts = {
        "versions": {name: version(name) for name in ("caretree", "numpy", "numba", "scipy")},
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
    }

    def keep() -> None:
        write_index(
            folder,
            spec,
            [shards[n] for n in sorted(shards)],
            {**facts, "processor_seconds": round(sum(s["seconds"] for s in shards.values()), 1)},
        )

    if missing:
        say(f"{spec.kind}: {len(shards)} of {count} shards are there, {len(missing)} to make")
    keep()
    for number, shard in each_shard(make_shard, missing, spec, jobs=jobs, address=address):
        replace_file(folder / shard["file"], shard.pop("bytes"))
        shards[number] = shard
        keep()
        fresh += shard["clips"]
        speed = fresh / (time.monotonic() - started)
        left = (spec.clips - sum(s["clips"] for s in shards.values())) / speed
        say(f"{spec.kind}: shard {number}, {len(shards)} of {count}, {speed:.1f} clips/s, {left / 60:.1f} min left")
    say(f"{folder}: {spec.clips} clips")
    return folder


def _finished(folder: Path, spec: DatasetSpec) -> dict[int, dict[str, Any]]:
    """Shards of this very dataset that are whole; a longer dataset keeps the full shards of a shorter one."""
    if not (folder / INDEX).is_file():
        if any(folder.glob("shard_*.npz")):
            raise CaretreeError(f"{folder}: there are shards but no {INDEX}; choose another folder")
        return {}
    index = read_index(folder)
    old = DatasetSpec(**index["spec"])
    if (old.kind, old.classes, old.seed) != (spec.kind, spec.classes, spec.seed) or old.per_class > spec.per_class:
        raise CaretreeError(
            f"{folder}: this folder holds {old.classes} x {old.per_class} clips of kind '{old.kind}' "
            f"with seed {old.seed}, not {spec.classes} x {spec.per_class} of '{spec.kind}' with seed "
            f"{spec.seed}; choose another folder"
        )
    whole = {}
    for shard in index["shards"]:
        number = int(shard["file"][6:10])
        if shard["clips"] == min(SHARD, spec.clips - number * SHARD):
            try:
                read_shard(folder / shard["file"], shard["sha256"])
            except CaretreeError:
                continue
            whole[number] = shard
    return whole


def say_to_stderr(text: str) -> None:
    """A line of progress for a person."""
    print(text, file=sys.stderr, flush=True)

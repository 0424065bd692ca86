"""A data set as the methods want it: frames instead of depth, computed once and kept beside the trained weights."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GownSpec
from ..clips.dataset import Dataset, DatasetSpec, numbers_of, read_index
from ..clips.frames import look_at
from .method import Examples


@dataclass(frozen=True, kw_only=True)
class Loaded:
    """A data set ready for use.

    Attributes:
        kind: as the data set calls itself.
        gowns: (N,) the cut that each clip shows.
        examples: all clips.
        split: (N,) `train`, `val` or `test`.
    """

    kind: str
    gowns: list[GownSpec]
    examples: Examples
    split: np.ndarray

    def where(self, name: str) -> np.ndarray:
        """Indices of the clips of one part.

        Raises:
            CaretreeError: there are none.
        """
        index = np.flatnonzero(self.split == name)
        if not len(index):
            raise CaretreeError(f"a data set of kind '{self.kind}' has no part '{name}'")
        return index

    def part(self, name: str) -> Examples:
        """The clips of one part.

        Raises:
            CaretreeError: there are none.
        """
        return self.examples.part(self.where(name))


def load_examples(folder: Path, cache: Path, *, partial: bool = False) -> Loaded:
    """Read a data set.

    Args:
        folder: the data set.
        cache: folder that keeps the frames.
        partial: take what is there of an unfinished data set.
    """
    index = read_index(folder)
    spec = DatasetSpec(**index["spec"])
    shards = hashlib.sha256("".join(shard["sha256"] for shard in index["shards"]).encode()).hexdigest()[:16]
    kept = cache / f"frames-{shards}.npz"
    if not kept.exists():
        data = Dataset.load(folder, partial=partial)
        cache.mkdir(parents=True, exist_ok=True)
        part = kept.with_suffix(".part.npz")
        seen = look_at(data.depth)
        np.savez(
            part,
            frames=seen.frames,
            rough=seen.rough,
            unit=data.unit,
            class_id=data.class_id,
            split=data.split,
            hash=data.hash,
            misplaced=np.array([spec.misplaced(i) for i in data.numbers]),
        )
        os.replace(part, kept)
    with np.load(kept) as file:
        examples = Examples(
            frames=file["frames"],
            unit=file["unit"].astype(float),
            class_id=file["class_id"],
            hash=str(file["hash"]),
            rough=file["rough"],
            misplaced=file["misplaced"],
        )
        split = file["split"]
    if len(examples) < spec.clips and not partial:
        raise CaretreeError(
            f"{folder}: {len(examples)} of {spec.clips} clips are made; make the others, or say --partial"
        )
    return Loaded(kind=spec.kind, gowns=[spec.gown_of(i) for i in numbers_of(index)], examples=examples, split=split)

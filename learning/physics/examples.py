"""A data set as the methods want it: frames instead of depth, computed once and kept beside the trained weights."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ...sim.errors import CaretreeError
from ...sim.gown import GownSpec
from .dataset import Dataset, DatasetSpec, read_index
from .frames import frames_of
from .method import Examples


@dataclass(frozen=True, kw_only=True)
class Loaded:
    """A data set ready for use.

    Attributes:
        kind: as the data set calls itself.
        gown: whose cut its clips show.
        examples: all clips.
        split: (N,) `train`, `val` or `test`.
    """

    kind: str
    gown: GownSpec
    examples: Examples
    split: np.ndarray

    def part(self, name: str) -> Examples:
        """The clips of one part.

        Raises:
            CaretreeError: there are none.
        """
        chosen = self.split == name
        if not chosen.any():
            raise CaretreeError(f"a data set of kind '{self.kind}' has no part '{name}'")
        return self.examples.part(chosen)


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
        np.savez(part, frames=frames_of(data.depth), unit=data.unit, class_id=data.class_id, split=data.split,
                 hash=data.hash)
        os.replace(part, kept)
    with np.load(kept) as file:
        examples = Examples(frames=torch.from_numpy(file["frames"]), unit=file["unit"].astype(float),
                            class_id=file["class_id"], hash=str(file["hash"]))
        if len(examples) < spec.clips and not partial:
            raise CaretreeError(f"{folder}: {len(examples)} of {spec.clips} clips are made; make the others, or say "
                                "--partial")
        return Loaded(kind=spec.kind, gown=spec.gown, examples=examples, split=file["split"])

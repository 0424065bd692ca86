"""A data set as the methods want it: frames instead of depth, computed once and kept beside the trained weights."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from ...sim.errors import CaretreeError
from ...sim.gown import GownSpec
from .dataset import Dataset
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
    data = Dataset.load(folder, partial=partial)
    kept = cache / f"frames-{data.hash}.npy"
    if not kept.exists():
        cache.mkdir(parents=True, exist_ok=True)
        part = kept.with_suffix(".part.npy")
        np.save(part, frames_of(data.depth))
        os.replace(part, kept)
    examples = Examples(frames=torch.from_numpy(np.load(kept)), unit=data.unit.astype(float), class_id=data.class_id,
                        hash=data.hash)
    return Loaded(kind=data.spec.kind, gown=data.spec.gown, examples=examples, split=data.split)

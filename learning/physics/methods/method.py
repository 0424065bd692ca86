"""What every method of identification offers, and the data all of them are given."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Examples:
    """Clips with known physics.

    Attributes:
        frames: (N, T, 2, S, S) float16, see frames.py; for networks, a tensor of these or of scores (N, S).
        unit: (N, 6) parameters in [0, 1].
        class_id: (N,) int, negative where the data has no classes.
        hash: of the data set they come from.
        rough: (N,) bool, clips with the gaps of a real camera; none when omitted.
        misplaced: (N, 6) how far each camera was from where the clip says, see camera.py; zero when omitted.
    """

    frames: Any
    unit: np.ndarray
    class_id: np.ndarray
    hash: str
    rough: np.ndarray | None = None
    misplaced: np.ndarray | None = None

    def __len__(self) -> int:
        """Number of clips."""
        return len(self.unit)

    @property
    def gaps(self) -> np.ndarray:
        """(N,) bool, `rough` or its default."""
        return np.zeros(len(self), bool) if self.rough is None else self.rough

    def part(self, chosen: np.ndarray) -> Examples:
        """The chosen clips (indices or a mask)."""
        index = np.flatnonzero(chosen) if chosen.dtype == bool else chosen
        known = {name: getattr(self, name) for name in ("rough", "misplaced")}
        some = {name: array[index] for name, array in known.items() if array is not None}
        return Examples(
            frames=self.frames[index], unit=self.unit[index], class_id=self.class_id[index], hash=self.hash, **some
        )

    def joined(self, others: Examples) -> Examples:
        """These clips and others; of what is known of them, what a network learns from."""
        return Examples(
            frames=np.concatenate([self.frames, others.frames]),
            hash=f"{self.hash}+{others.hash}",
            unit=np.concatenate([self.unit, others.unit]),
            class_id=np.concatenate([self.class_id, others.class_id]),
        )


class Method(ABC):
    """Clip -> six parameters.  A fitted method; how each is fitted is its own file's matter."""

    name: str

    @abstractmethod
    def estimate(self, frames: Any) -> np.ndarray:
        """Parameters of each clip: (N, T, 2, S, S) -> (N, 6) in [0, 1]."""

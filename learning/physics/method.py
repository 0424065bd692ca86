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
        misplaced: (N, 6) how far each camera was from where the clip says, see film_camera.py; zero when omitted.
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
        return Examples(frames=self.frames[index], unit=self.unit[index], class_id=self.class_id[index],
                        hash=self.hash, rough=None if self.rough is None else self.rough[index],
                        misplaced=None if self.misplaced is None else self.misplaced[index])


class Method(ABC):
    """Clip -> six parameters.  A fitted method; how each is fitted is its own file's matter."""

    name: str

    @abstractmethod
    def estimate(self, frames: Any) -> np.ndarray:
        """Parameters of each clip: (N, T, 2, S, S) -> (N, 6) in [0, 1]."""

"""What every method of identification offers, and the data all of them are given."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`


@dataclass(frozen=True, kw_only=True)
class Examples:
    """Clips with known physics.

    Attributes:
        frames: (N, T, 2, S, S) float16, see frames.py.
        unit: (N, 6) parameters in [0, 1].
        class_id: (N,) int, negative where the data has no classes.
        hash: of the data set they come from.
    """

    frames: torch.Tensor
    unit: np.ndarray
    class_id: np.ndarray
    hash: str

    def __len__(self) -> int:
        """Number of clips."""
        return len(self.unit)

    def part(self, chosen: np.ndarray) -> Examples:
        """The chosen clips (indices or a mask)."""
        index = np.flatnonzero(chosen) if chosen.dtype == bool else chosen
        return Examples(frames=self.frames[torch.from_numpy(index)], unit=self.unit[index],
                        class_id=self.class_id[index], hash=self.hash)


class Method(ABC):
    """Clip -> six parameters.  A fitted method; how each is fitted is its own file's matter."""

    name: str

    @abstractmethod
    def estimate(self, frames: torch.Tensor) -> np.ndarray:
        """Parameters of each clip: (N, T, 2, S, S) -> (N, 6) in [0, 1]."""

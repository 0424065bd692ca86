"""Slowing down before a load is reached: a hand that is told to stop goes on for centimetres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class LoadEasing(Quantities):
    """How a pull slows down over the last newtons below the load that ends it."""

    margin: float = quantity(
        2.0, "N", "below the greatest load, where slowing down begins", "choice: a stopped hand goes on for centimetres"
    )
    min_share: float = quantity(
        0.3, "1", "share of the speed left at the greatest load", "choice: a pull that slows down still gets there"
    )

    def share(self, load: np.ndarray, max_load: float) -> float:
        """Share of the wanted speed under a load (3,) [N] where a load of `max_load` [N] ends the pull."""
        return float(np.clip((max_load - np.linalg.norm(load)) / self.margin, self.min_share, 1.0))

"""How fast a hand that holds an arm gives way: faster under a pull that stays, slower under one that turns back.

What pulls is a sleeve, soft, or the arm itself, which answers to a millimetre with 7 N where it is held at the elbow
and with 45 N above it.  A hand that gives way soon enough to the one swings against the other.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class GiveWayTuning(Quantities):
    """Speed of giving way to each newton."""

    first: float = quantity(
        0.0005,
        "m/s/N",
        "at first",
        "choice: stable where an arm answers with 20 N/mm, one tick of 1/15 s late; 0.0008 is not",
    )
    least: float = quantity(0.0002, "m/s/N", "at least", "choice: stable under 45 N/mm, the most that was measured")
    most: float = quantity(
        0.0015,
        "m/s/N",
        "at most",
        "measured: at 0.004 a held arm and the hand swung against each other three to five times a second, with 25 to "
        "50 N (101, 104); stable where an arm answers with 7 N/mm, held at its elbow",
    )
    growth: float = quantity(2.0, "1/s", "of its logarithm, under a pull that stays", "choice: sevenfold in a second")
    back: float = quantity(
        0.2,
        "1",
        "share of it that is left once a pull turns back",
        "choice: a springy arm of 3 to 45 N/mm that drifts off by 2 mm/s then pulls with 24 N at most",
    )
    remembered: int = quantity(
        3, "1", "pulls with which one is compared", "choice: half a swing, seen 15 times a second"
    )
    pause: float = quantity(1.0, "s", "without being asked, after which it begins anew", "choice: another hold")


GIVE_WAY = GiveWayTuning()


class GiveWay:
    """One hand's giving way; asked on every tick.

    Args:
        tuning: how fast.
    """

    def __init__(self, tuning: GiveWayTuning = GIVE_WAY) -> None:
        self._tuning = tuning
        self._speed = tuning.first
        self._asked = -np.inf
        self._pulls: deque[np.ndarray] = deque(maxlen=tuning.remembered)

    def velocity(self, pull: np.ndarray, now: float) -> np.ndarray:
        """Velocity (3,) [m/s] under the part of a pull (3,) that is not borne [N], at a time [s]."""
        tuning = self._tuning
        step, self._asked = now - self._asked, now
        if step > tuning.pause:
            self._speed, step = tuning.first, 0.0
            self._pulls.clear()
        if np.any(pull):
            if any(before @ pull < 0.0 for before in self._pulls):
                self._speed = max(tuning.back * self._speed, tuning.least)
                self._pulls.clear()
            else:
                self._speed = min(self._speed * math.exp(tuning.growth * step), tuning.most)
            self._pulls.append(np.array(pull, float))
        return self._speed * pull

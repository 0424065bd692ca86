"""A robot hand that holds the person's arm."""

from __future__ import annotations

from dataclasses import dataclass

from ...sim.world import Side


@dataclass(frozen=True)
class Hold:
    """A robot hand that holds the person's arm at a place: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip."""

    hand: Side
    place: float

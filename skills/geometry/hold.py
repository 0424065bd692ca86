"""A robot hand that holds the person's arm."""

from __future__ import annotations

from dataclasses import dataclass

from ...sim.world import Side


@dataclass(frozen=True)
class Hold:
    """A robot hand that holds the person's arm.

    Attributes:
        hand: of the robot.
        coordinate: arm coordinate of the grip: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.
    """

    hand: Side
    coordinate: float

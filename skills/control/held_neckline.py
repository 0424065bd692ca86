"""The neckline of a gown between both hands, across the bed: how far apart they are, and where its middle is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Side
from ..core.skill import Skill
from .hands import Way, hand_now, move_hands

# The robot stands at the person's right, facing the head of the bed.
NEAR_HAND: Side = "left"  # the hand nearer to the robot's edge of the bed
NEAR_SLEEVE: Side = "right"  # the wearer's side of the sleeve that this hand holds


@dataclass(frozen=True, kw_only=True)
class NecklineTuning(Quantities):
    """How both hands move a neckline."""

    speed: float = quantity(0.25, "m/s", "of each hand", "choice: the gown hardly swings")
    min_near_x: float = quantity(
        0.35,
        "m",
        "of the near hand, at least",
        "choice: how it was found is not recorded; nearer, the hand is beside the base",
    )


@dataclass
class HeldNeckline:
    """Both ends of a neckline in the hands of the robot.

    Attributes:
        skill: that moves.
        apart: distance between the hands [m].
        middle: x of the neckline's middle in the map [m].
        tuning: how it is moved.
    """

    skill: Skill
    apart: float
    middle: float
    tuning: NecklineTuning

    def to(self, y: float, z: float, share: float = 1.0, *, way: Way = "either") -> Iterator[None]:
        """Both hands to the ends of a neckline at (y, z) [m, map], or a `share` of the `way` there, turned anyhow.

        Raises:
            MotionError: out of reach, or something is in the way.
        """
        half = self.apart / 2
        goals: dict[Side, np.ndarray] = {}
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            pose = hand_now(self.skill, side)
            there = np.array((max(self.middle, self.tuning.min_near_x - half) + sign * half, y, z))
            pose[:3, 3] += share * (there - pose[:3, 3])
            goals[side] = pose
        yield from move_hands(self.skill, goals, speed=self.tuning.speed, free="any", way=way)

"""The neckline of a gown between both hands, across the bed: how far apart they are, and where its middle is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.kinematics import kinematics_of
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..core.skill import Skill
from ..motion.errors import MotionError
from ..motion.reach import plan_hand_line
from .hands import Way, collision_checker, hand_now, move_hands

# The robot stands at the person's right, facing the head of the bed.
NEAR_HAND: Side = "left"  # the hand nearer to the robot's edge of the bed
FAR_HAND: Side = "right"
NEAR_SLEEVE: Side = "right"  # the wearer's side of the sleeve that the near hand holds


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
    lower_by: float = quantity(
        0.45,
        "m",
        "by which one end, mostly the far one, hangs lower than the other",
        "measured: far back panels that hung folded over the front fell open on 3 of 4 gowns, by 0.3 m on 2 of 4, "
        "level on none (125, 133, 136, 139)",
    )
    behind: float = quantity(
        0.30,
        "m",
        "nearer to the feet, of the near end where that is the one that hangs lower",
        "choice: the panel beside it trails outwards as the neckline is drawn towards the head",
    )
    level_from: float = quantity(
        0.83,
        "m",
        "height at which both ends are level again, and below",
        "measured: at 0.80 m the far arm of a UR5 pair comes near to a singular posture; from 0.70 m a far hand of "
        "Baxter does not reach the places across the bed",
    )


@dataclass
class HeldNeckline:
    """Both ends of a neckline in the hands of the robot, one of them lower while the gown hangs, mostly the far one.

    The back panel beyond an armhole hangs from the end of the neckline beside it, and turns about its edge as a door
    does: folded over the front it stays there, hung lower it falls open.

    Attributes:
        skill: that moves.
        apart: distance between the hands [m].
        middle: x of the neckline's middle in the map [m].
        tuning: how it is moved.
        lower: the hand whose end hangs lower.
    """

    skill: Skill
    apart: float
    middle: float
    tuning: NecklineTuning
    lower: Side = FAR_HAND

    def to(self, y: float, z: float, share: float = 1.0, *, way: Way = "either") -> Iterator[None]:
        """Both hands to the ends of a neckline at (y, z) [m, map], or a `share` of the `way` there, turned anyhow.

        The height is that of the higher end; the other one is lower by `lower_by`, as long as it is above `level_from`,
        and, if it is the near one, as much nearer to the feet.
        They are `apart` along the neckline: as far apart across the bed, the one end lower, they stretched it by 0.1 m,
        and the cloth by a quarter (173).

        Raises:
            MotionError: out of reach, or something is in the way.
        """
        goals = self._goals(y, z, share)
        yield from move_hands(self.skill, goals, speed=self.tuning.speed, free="any", way=way)

    def reaches(self, y: float, z: float) -> bool:
        """Whether both hands get straight to the ends of a neckline at (y, z) [m, map]."""
        seen, kinematics = self.skill.world.observe(), kinematics_of(self.skill.world.robot)
        at = seen.arm_positions, seen.pose_base_in_map
        try:
            plan_hand_line(kinematics, self._goals(y, z), *at, free="any", checker=collision_checker(self.skill))
        except MotionError:
            return False
        return True

    def _goals(self, y: float, z: float, share: float = 1.0) -> dict[Side, np.ndarray]:
        """Poses (4, 4) of both hands in the map."""
        tuning = self.tuning
        drop = z - min(z, max(z - tuning.lower_by, tuning.level_from))
        behind = tuning.behind * drop / tuning.lower_by if self.lower == NEAR_HAND else 0.0
        half = math.sqrt(max(self.apart**2 - drop**2 - behind**2, 0.0)) / 2
        ends: dict[Side, float] = {NEAR_HAND: 1.0, FAR_HAND: -1.0}
        goals: dict[Side, np.ndarray] = {}
        for side, sign in ends.items():
            pose = hand_now(self.skill, side)
            across = max(self.middle, tuning.min_near_x - half) + sign * half
            there = np.array((across, y + sign * behind / 2, z - (drop if side == self.lower else 0.0)))
            pose[:3, 3] += share * (there - pose[:3, 3])
            goals[side] = pose
        return goals

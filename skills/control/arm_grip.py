"""How a hand takes a person's arm: from above, fingers across it, softly; and how it knows that it has it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...perception.estimates import ArmPosture
from ...perception.image.cloud import unit
from ...sim.robot.kinematics import default_kinematics
from ...sim.world import SIDES, Side
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP, ArmPath
from ..motion.errors import Unreachable
from ..motion.ik import hand_pose, solve_ik
from ..motion.trajectory import free_postures
from .hands import collision_checker

FORCE = 28.0  # squeezing an arm; the guard allows 30 [N]
ARM_MIN = 0.045  # fingers that stay further apart than this hold an arm [m]


def over_arm(posture: ArmPosture, place: float, lift: float) -> np.ndarray:
    """Pose (4, 4) of a hand pointing straight down, `lift` [m] above a place of the arm, closing across it."""
    path = ArmPath.of(posture)
    across = unit(np.cross(path.direction(place), UP))
    return hand_pose(path.point(place) + lift * UP, -UP, across)


def top_down_reachable(
    skill: Skill, side: Side, pose: np.ndarray, then: Sequence[np.ndarray] = (np.zeros(3),)
) -> np.ndarray:
    """`pose`, or the same turned by half a turn about the approach, whichever the arm takes more easily.

    Args:
        skill: that asks.
        side: of the robot.
        pose: (4, 4); the two fingers are alike, so the turned one is as good.
        then: ways (3,) from there to places that must be within reach with the same turn [m].

    Raises:
        Unreachable: neither can be reached.
    """
    seen, kinematics = skill.world.observe(), default_kinematics()
    n, limits = SIDES.index(side), kinematics.limits[side]
    accept = free_postures(collision_checker(skill), side, seen.pose_base_in_map, seen.arm_positions)
    best: tuple[float, np.ndarray] | None = None
    tries = Tries(Unreachable)
    for turned in (pose, pose @ np.diag((-1.0, -1.0, 1.0, 1.0))):
        with tries:
            room, q = np.inf, seen.arm_positions[n]
            for way in then:
                there = turned.copy()
                there[:3, 3] += way
                q = solve_ik(kinematics, side, there, seen.pose_base_in_map, q, accept=accept)
                room = min(room, float(np.min(np.minimum(q - limits.lower, limits.upper - q))))
            if best is None or room > best[0] + 0.05:
                best = (room, turned)
    if best is None:
        raise tries.last
    return best[1]


def lost_arm(skill: Skill, side: Side) -> bool:
    """Whether the fingers of a hand that should hold an arm have closed on nothing."""
    return bool(skill.world.observe().gripper_opening[SIDES.index(side)] < ARM_MIN)

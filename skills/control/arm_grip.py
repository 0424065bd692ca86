"""How a hand takes a person's arm, softly from above with the fingers across it, and knows that it has it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...perception.estimates import ArmPosture
from ...perception.image.cloud import unit
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Side
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP, ArmPath
from ..motion.errors import Unreachable
from ..motion.ik import half_turned, hand_pose, solve_ik
from ..motion.trajectory import free_postures
from .fingers import FINGERS
from .hands import collision_checker


@dataclass(frozen=True, kw_only=True)
class ArmGripTuning(Quantities):
    """How a person's arm is taken."""

    force: float = quantity(28.0, "N", "of squeezing an arm", "choice: just below the 30 N that the guard allows")
    min_gap: float = quantity(
        0.045, "m", "between the fingertips, from which on they hold an arm", "choice: thinner than any adult's arm"
    )
    min_gain: float = quantity(
        0.05,
        "rad",
        "more room to the joint limits for which the hand turns round",
        "choice: turning takes time",
    )


ARM_GRIP = ArmGripTuning()


def over_arm(posture: ArmPosture, coordinate: float, lift: float) -> np.ndarray:
    """Pose (4, 4) in the map of a hand square to an arm, from above, `lift` [m] off a coordinate; it closes across it.

    A hand that points straight down would have its palm in an arm that rises.
    """
    path = ArmPath.of(posture)
    along = path.direction(coordinate)
    away = unit(UP - (UP @ along) * along)
    return hand_pose(path.point(coordinate) + lift * away, -away, unit(np.cross(along, UP)))


def top_down_reachable(
    skill: Skill,
    side: Side,
    pose: np.ndarray,
    then: Sequence[np.ndarray] = (np.zeros(3),),
    *,
    clear: bool = True,
    tuning: ArmGripTuning = ARM_GRIP,
) -> np.ndarray:
    """`pose`, or the same turned by half a turn about the approach, whichever the arm takes more easily.

    Args:
        skill: that asks.
        side: of the robot.
        pose: (4, 4) in the map; the two fingers are alike, so the turned one is as good.
        then: offsets (3,) from there to positions that must be within reach with the same turn [m].
        clear: whether the postures must be free; not where the arm itself, which goes along, is in the way now.
        tuning: how much easier the turned one must be.

    Raises:
        Unreachable: neither can be reached.
    """
    seen, kinematics = skill.world.observe(), kinematics_of(skill.world.robot)
    n, limits = SIDES.index(side), kinematics.limits[side]
    checker = collision_checker(skill) if clear else None
    accept = checker and free_postures(checker, side, seen.pose_base_in_map, seen.arm_positions)
    best: tuple[float, np.ndarray] | None = None
    tries = Tries(Unreachable)
    for turned in (pose, half_turned(pose)):
        with tries:
            room, q = np.inf, seen.arm_positions[n]
            for way in then:
                there = turned.copy()
                there[:3, 3] += way
                q = solve_ik(kinematics, side, there, seen.pose_base_in_map, q, accept=accept)
                room = min(room, limits.margin(q))
            if best is None or room > best[0] + tuning.min_gain:
                best = (room, turned)
    if best is None:
        raise tries.last
    return best[1]


def holds_arm(skill: Skill, side: Side, *, tuning: ArmGripTuning = ARM_GRIP) -> bool:
    """Whether fingers that are neither open nor on each other hold what is as thick as an arm."""
    opening = skill.world.observe().gripper_opening[SIDES.index(side)]
    return bool(tuning.min_gap <= opening < skill.world.robot.gripper.stroke - FINGERS.open_tolerance)


def lost_arm(skill: Skill, side: Side, *, tuning: ArmGripTuning = ARM_GRIP) -> bool:
    """Whether the fingers of a hand that should hold an arm have closed on nothing."""
    return bool(skill.world.observe().gripper_opening[SIDES.index(side)] < tuning.min_gap)

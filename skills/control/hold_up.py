"""Hold what one hand carries up in front of the head camera, and turn it there.

    yield from present(self, "right", 0.5)

The hand points down, so that what hangs from it is seen below the arm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...sim.mechanics.kinematics import kinematics_of
from ...sim.mechanics.planar import planar_pose
from ...sim.mechanics.robot_model import RobotModel
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, JointTrajectory, Side
from ..core.skill import Skill
from ..motion.errors import MotionBlocked
from ..motion.ik import solve_ik
from ..motion.trajectory import plan_joint_motion
from .follow import follow
from .hands import HANDS, collision_checker, move_arms


@dataclass(frozen=True, kw_only=True)
class HoldUpTuning(Quantities):
    """How a hand is held up before the head camera."""

    max_turn: float = quantity(
        math.radians(150.0),
        "rad",
        "of the hand about the vertical to either side",
        "measured: every 15 degrees with the collision shapes, nothing touches and the arm does not hide the gown",
    )
    turn_step: float = quantity(
        math.radians(15.0), "rad", "between two postures of a turn", "choice: as it was tried; the elbow stays the same"
    )
    turn_tolerance: float = quantity(0.03, "rad", "beyond the greatest turn", "choice: the servo's error")
    posture_tolerance: float = quantity(
        0.1, "rad", "of each joint at which a hand counts as held up", "choice: above the servo's error"
    )


HOLD_UP = HoldUpTuning()


def presenting(robot: RobotModel, side: Side, angle: float = 0.0, *, tuning: HoldUpTuning = HOLD_UP) -> np.ndarray:
    """Angles (2, n) of a robot with one hand held up and turned by `angle`, the other arm ready [rad]."""
    arms = robot.ready.copy()
    arms[SIDES.index(side)] = presented(robot, side, angle, tuning=tuning)
    return arms


def presented(robot: RobotModel, side: Side, angle: float, *, tuning: HoldUpTuning = HOLD_UP) -> np.ndarray:
    """Angles (n,) of the arm whose hand is held up, turned about the vertical by `angle`, positive to the left [rad].

    The same angle always gives the same elbow, whatever the arm did before.

    Raises:
        ValueError: it turns farther than the arm can without touching anything.
    """
    if abs(angle) > tuning.max_turn + 1e-9:
        raise ValueError(
            f"a presented hand turns by at most {np.rad2deg(tuning.max_turn):.0f} degrees to either side, "
            f"not by {np.rad2deg(angle):.0f}"
        )
    return _chain(robot, side, round(float(angle), 6), tuning)[-1].copy()


def present(
    skill: Skill, side: Side, angle: float, *, speed: float = HANDS.speed, tuning: HoldUpTuning = HOLD_UP
) -> Iterator[None]:
    """Hold a hand up, turned by `angle` about the vertical [rad], and the other arm out of the way.

    A hand that is up already turns where it is.

    Raises:
        MotionError: something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    robot = skill.world.robot
    if turned_by(robot, side, skill.world.observe().arm_positions[SIDES.index(side)], tuning=tuning) is None:
        yield from move_arms(skill, presenting(robot, side, angle, tuning=tuning), speed=speed)
    else:
        yield from follow(skill, plan_turn(skill, side, angle, tuning=tuning))


def plan_turn(
    skill: Skill, side: Side, angle: float, *, scale: float = 1.0, tuning: HoldUpTuning = HOLD_UP
) -> JointTrajectory:
    """Turn a hand that is held up to `angle` [rad], with `scale` of the joints' speed.

    Raises:
        MotionError: it is not held up, or something is in the way.
    """
    seen = skill.world.observe()
    q = seen.arm_positions[SIDES.index(side)]
    robot = skill.world.robot
    here = turned_by(robot, side, q, tuning=tuning)
    if here is None:
        raise MotionBlocked(f"the {side} hand is not held up, so it cannot turn there")
    between = np.linspace(here, angle, int(np.ceil(abs(angle - here) / tuning.turn_step)) + 1)[1:]
    points = np.array([q, *(presented(robot, side, turn, tuning=tuning) for turn in between)])
    return plan_joint_motion(
        kinematics_of(robot),
        {side: points},
        seen.pose_base_in_map,
        speed_scale=scale,
        checker=collision_checker(skill),
        other_arm=seen.arm_positions[1 - SIDES.index(side)],
    )


def turned_by(robot: RobotModel, side: Side, q: np.ndarray, *, tuning: HoldUpTuning = HOLD_UP) -> float | None:
    """By how much the hand of an arm (n,) [rad] is turned [rad], or None when it is not held up."""
    pose = kinematics_of(robot).pose_hand_in_base(side, q)
    angle = math.atan2(-pose[0, 1], pose[1, 1])
    if abs(angle) > tuning.max_turn + tuning.turn_tolerance:
        return None
    angle = float(np.clip(angle, -tuning.max_turn, tuning.max_turn))
    off = np.abs(presented(robot, side, angle, tuning=tuning) - q).max()
    return angle if off < tuning.posture_tolerance else None


@lru_cache(maxsize=256)
def _chain(robot: RobotModel, side: Side, angle: float, tuning: HoldUpTuning) -> tuple[np.ndarray, ...]:
    """Angles on the way from no turn to `angle`, in steps of at most `turn_step`."""
    kinematics = kinematics_of(robot)
    chain = [robot.held_up[SIDES.index(side)]]
    start = kinematics.pose_hand_in_base(side, chain[0])
    for share in np.linspace(0.0, 1.0, int(np.ceil(abs(angle) / tuning.turn_step)) + 1)[1:]:
        pose = start.copy()
        pose[:3, :3] = planar_pose(np.array((0.0, 0.0, share * angle)))[:3, :3] @ start[:3, :3]
        chain.append(solve_ik(kinematics, side, pose, np.zeros(3), chain[-1], seeds=1))
    return tuple(chain)

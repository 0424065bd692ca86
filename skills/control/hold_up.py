"""Hold what one hand carries up in front of the head camera, and turn it there.

    yield from present(self, "right", 0.5)

The hand points down, so that what hangs from it is seen below the arm.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from ...sim.robot import model
from ...sim.robot.kinematics import default_kinematics, planar_pose
from ...sim.world import SIDES, JointTrajectory, Side
from ..core.skill import Skill
from ..motion.errors import MotionBlocked
from ..motion.ik import solve_ik
from ..motion.trajectory import plan_joint_motion
from .follow import follow
from .hands import SPEED, collision_checker, move_arms

MIRROR = np.array((-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0))  # left and right arm are mirror images

# Fingertips 0.70 m ahead and 0.15 m to their side of the middle, 1.33 m above the floor, pointing down, so that the
# camera sees what hangs from them under the arm.  From there the hand turns about the vertical by 150 degrees to both
# sides without the arm touching anything or hiding the gown (tried every 15 degrees with the collision shapes).
_RIGHT = np.array((0.284, -1.137, 1.275, 0.913, -0.47, 2.046, 0.517))
PRESENT: dict[Side, np.ndarray] = {"right": _RIGHT, "left": MIRROR * _RIGHT}  # (7,) [rad]
RANGE = np.deg2rad(150.0)
_STEP = np.deg2rad(15.0)


def presenting(side: Side, angle: float = 0.0) -> np.ndarray:
    """Angles (2, 7) with one hand held up and turned by `angle`, the other arm ready [rad]."""
    arms = model.READY.copy()
    arms[SIDES.index(side)] = presented(side, angle)
    return arms


def presented(side: Side, angle: float) -> np.ndarray:
    """Angles (7,) of the arm whose hand is held up, turned about the vertical by `angle`, positive to the left [rad].

    The same angle always gives the same elbow, whatever the arm did before.

    Raises:
        ValueError: more than `RANGE`.
    """
    if abs(angle) > RANGE + 1e-9:
        raise ValueError(
            f"a presented hand turns by at most {np.rad2deg(RANGE):.0f} degrees to either side, "
            f"not by {np.rad2deg(angle):.0f}"
        )
    return _chain(side, round(float(angle), 6))[-1].copy()


def present(skill: Skill, side: Side, angle: float, *, speed: float = SPEED) -> Iterator[None]:
    """Hold a hand up, turned by `angle` about the vertical [rad], and the other arm out of the way.

    A hand that is up already turns where it is.

    Raises:
        MotionError: something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    if turned_by(side, skill.world.observe().arm_positions[SIDES.index(side)]) is None:
        yield from move_arms(skill, presenting(side, angle), speed=speed)
    else:
        yield from follow(skill, plan_turn(skill, side, angle))


def plan_turn(skill: Skill, side: Side, angle: float, *, scale: float = 1.0) -> JointTrajectory:
    """Turn a hand that is held up to `angle` [rad], with `scale` of the joints' speed.

    Raises:
        MotionError: it is not held up, or something is in the way.
    """
    seen = skill.world.observe()
    q = seen.arm_positions[SIDES.index(side)]
    here = turned_by(side, q)
    if here is None:
        raise MotionBlocked(f"the {side} hand is not held up, so it cannot turn there")
    between = np.linspace(here, angle, int(np.ceil(abs(angle - here) / _STEP)) + 1)[1:]
    points = np.array([q, *(presented(side, turn) for turn in between)])
    return plan_joint_motion(
        default_kinematics(),
        {side: points},
        seen.pose_base_in_map,
        speed_scale=scale,
        checker=collision_checker(skill),
        other_arm=seen.arm_positions[1 - SIDES.index(side)],
    )


def turned_by(side: Side, q: np.ndarray) -> float | None:
    """By how much the hand of an arm (7,) is turned [rad], or None when it is not held up."""
    pose = default_kinematics().pose_hand_in_base(side, q)
    angle = float(np.arctan2(-pose[0, 1], pose[1, 1]))
    if abs(angle) > RANGE + 0.03:
        return None
    angle = float(np.clip(angle, -RANGE, RANGE))
    return angle if np.abs(presented(side, angle) - q).max() < 0.1 else None


@lru_cache(maxsize=256)
def _chain(side: Side, angle: float) -> tuple[np.ndarray, ...]:
    """Angles on the way from no turn to `angle`, in steps of at most `_STEP`."""
    kinematics = default_kinematics()
    chain = [PRESENT[side]]
    start = kinematics.pose_hand_in_base(side, chain[0])
    for share in np.linspace(0.0, 1.0, int(np.ceil(abs(angle) / _STEP)) + 1)[1:]:
        pose = start.copy()
        pose[:3, :3] = planar_pose(np.array((0.0, 0.0, share * angle)))[:3, :3] @ start[:3, :3]
        chain.append(solve_ik(kinematics, side, pose, np.zeros(3), chain[-1], seeds=1))
    return tuple(chain)

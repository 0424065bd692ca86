"""The head in motion: generators that skills use with `yield from`.

yield from look_towards(self, point)   # pans until the point is in the middle of the picture's width
yield from pan_head(self, 0.0)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.kinematics import kinematics_of
from ...sim.mechanics.planar import planar_pose
from ...sim.quantity import Quantities, quantity
from ...sim.world import JointTrajectory
from ..core.skill import Skill
from .follow import follow


@dataclass(frozen=True, kw_only=True)
class HeadTuning(Quantities):
    """Numbers of turning the head."""

    tolerance: float = quantity(0.03, "rad", "of the head's angle", "choice: a small part of the picture's width")
    extra_time: float = quantity(0.2, "s", "more than the head's speed asks for", "choice: it starts and stops gently")
    peak: float = quantity(
        1.5, "1", "greatest speed of a smooth motion, as a multiple of its mean", "design: that of a cubic polynomial"
    )


HEAD = HeadTuning()


def look_towards(skill: Skill, point_in_map: np.ndarray, *, tolerance: float = HEAD.tolerance) -> Iterator[None]:
    """Pan the head so that `point_in_map` (2,) or (3,) lies in the middle of the image's width."""
    seen = skill.world.observe()
    x, y, yaw = seen.pose_base_in_map
    neck = planar_pose(seen.pose_base_in_map)[:3, :3] @ skill.world.robot.neck_in_base + (x, y, 0.0)
    wanted = np.arctan2(point_in_map[1] - neck[1], point_in_map[0] - neck[0]) - yaw
    yield from pan_head(skill, float((wanted + np.pi) % (2 * np.pi) - np.pi), tolerance=tolerance)


def pan_head(
    skill: Skill, angle: float, *, tolerance: float = HEAD.tolerance, tuning: HeadTuning = HEAD
) -> Iterator[None]:
    """Turn the head to `angle` [rad], positive to the left, as far as the neck can."""
    robot = skill.world.robot
    low, high = kinematics_of(robot).head_range
    here, angle = float(skill.world.observe().head_pan), float(np.clip(angle, low, high))
    if abs(angle - here) <= tolerance:
        return
    duration = tuning.peak * abs(angle - here) / robot.limits.head_velocity + tuning.extra_time
    times, positions = np.array((0.0, duration)), np.array(((here,), (angle,)))
    turn = JointTrajectory(joints=(robot.head_joint,), times=times, positions=positions)
    yield from follow(skill, turn, tolerance=tolerance)

"""The head in motion: generators that skills use with `yield from`.

yield from look_towards(self, point)   # pans until the point is in the middle of the picture's width
yield from pan_head(self, 0.0)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.capsules import RobotCapsules
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.mechanics.planar import planar_pose
from ...sim.quantity import Quantities, quantity
from ...sim.segments import capsule_gaps
from ...sim.world import JointTrajectory, Observation
from ..core.skill import Skill
from .follow import follow

HEAD_LINK = "head"  # of a robot's capsules and own pairs


@dataclass(frozen=True, kw_only=True)
class HeadTuning(Quantities):
    """Numbers of turning the head."""

    tolerance: float = quantity(0.03, "rad", "of the head's angle", "choice: a small part of the picture's width")
    extra_time: float = quantity(0.2, "s", "more than the head's speed asks for", "choice: it starts and stops gently")
    peak: float = quantity(
        1.5, "1", "greatest speed of a smooth motion, as a multiple of its mean", "design: that of a cubic polynomial"
    )
    arm_gap: float = quantity(
        0.04,
        "m",
        "from the head to the robot's arms, to be kept where it looks",
        "choice: four times what the guard keeps, as the arms go on; it stopped a pull at 0.01 m (132)",
    )
    max_aside: float = quantity(
        0.35, "rad", "of what it looks at, to keep that gap", "choice: well inside a picture that is 1.57 rad wide"
    )
    coming_gap: float = quantity(
        0.08,
        "m",
        "from the head to an arm that moves, from which on it turns away",
        "measured: from 0.04 m on the elbow came nearer faster than the head turned, to 0.02 m, where the guard let "
        "the hand crawl (134)",
    )
    max_turned: float = quantity(
        0.6, "rad", "of what it looks at while an arm comes near, the same", "choice: still inside that picture"
    )
    step: float = quantity(
        0.1, "rad", "by which it then turns at once", "choice: small, as it is asked for at each tick"
    )
    step_time: float = quantity(0.3, "s", "that this takes", "choice: a third of the head's speed")
    asides: int = quantity(5, "1", "angles that are tried to either side", "choice: 4 degrees between them")


HEAD = HeadTuning()


def look_towards(skill: Skill, point_in_map: np.ndarray, *, tolerance: float = HEAD.tolerance) -> Iterator[None]:
    """Pan the head so that `point_in_map` (2,) or (3,) lies in the middle of the image's width.

    Where an arm of the robot is near the head then, the point lies beside the middle.
    """
    pan = _off_the_arms(skill, _bearing(skill, point_in_map))
    yield from pan_head(skill, pan, tolerance=tolerance)


def keep_off_the_arms(skill: Skill, point_in_map: np.ndarray, tuning: HeadTuning = HEAD) -> None:
    """Start to turn the head away from an arm of the robot that comes near it, the point still in the picture.

    Args:
        skill: that looks; once in each of its ticks.
        point_in_map: (2,) or (3,) that it looks at [m].
        tuning: numbers of turning the head.
    """
    gap, seen, robot = arm_gaps(skill), skill.world.observe(), skill.world.robot
    if (room := gap(seen, seen.head_pan)) >= tuning.coming_gap:
        return
    bearing, (low, high) = _bearing(skill, point_in_map), kinematics_of(robot).head_range
    low, high = max(low, bearing - tuning.max_turned), min(high, bearing + tuning.max_turned)
    turned = [float(np.clip(seen.head_pan + step, low, high)) for step in (-tuning.step, tuning.step)]
    best = max(turned, key=lambda angle: gap(seen, angle))
    if gap(seen, best) > room:
        times, positions = np.array((0.0, tuning.step_time)), np.array(((seen.head_pan,), (best,)))
        skill.world.send(JointTrajectory(joints=(robot.head_joint,), times=times, positions=positions))


def _bearing(skill: Skill, point_in_map: np.ndarray) -> float:
    """Angle of the head at which a point (2,) or (3,) is in the middle of the picture's width [rad]."""
    seen = skill.world.observe()
    x, y, yaw = seen.pose_base_in_map
    neck = planar_pose(seen.pose_base_in_map)[:3, :3] @ skill.world.robot.neck_in_base + (x, y, 0.0)
    wanted = math.atan2(point_in_map[1] - neck[1], point_in_map[0] - neck[0]) - yaw
    return float((wanted + np.pi) % (2 * np.pi) - np.pi)


def _off_the_arms(skill: Skill, wanted: float, tuning: HeadTuning = HEAD) -> float:
    """The angle of the head next to the wanted one that leaves the robot's arms room, or that leaves most [rad]."""
    gap, seen = arm_gaps(skill), skill.world.observe()
    aside = np.linspace(0.0, tuning.max_aside, tuning.asides + 1)[1:]
    angles = [wanted, *(float(wanted + sign * step) for step in aside for sign in (1.0, -1.0))]
    best, most = wanted, -np.inf
    for angle in np.clip(angles, *kinematics_of(skill.world.robot).head_range):
        room = gap(seen, float(angle))
        if room >= tuning.arm_gap:
            return float(angle)
        if room > most:
            best, most = float(angle), room
    return best


def arm_gaps(skill: Skill) -> Callable[[Observation, float], float]:
    """How far the robot's arms, as they are observed, would be from its head at an angle [rad] of that [m]."""
    robot = skill.world.robot
    links = skill.context.memory.of(RobotCapsules, lambda: RobotCapsules(kinematics_of(robot)))
    of = [capsule.link for capsule in links.capsules]
    near = {link for pair in robot.own_pairs if HEAD_LINK in pair for link in pair} - {HEAD_LINK}
    head, arms = np.array([link == HEAD_LINK for link in of]), np.array([link in near for link in of])

    def gap(seen: Observation, angle: float) -> float:
        if not (head.any() and arms.any()):
            return np.inf
        ends = links.ends(seen.pose_base_in_map, seen.arm_positions, angle, seen.gripper_opening)
        return float(capsule_gaps(ends[arms], links.radii[arms], ends[head], links.radii[head])[0].min())

    return gap


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

"""Hands, fingers and head in motion: generators that skills use with `yield from`.

    yield from move_hands(self, {"right": pose})                        # straight, poses (4, 4) in the map
    yield from move_hands(self, {"left": a, "right": b}, speed=0.5, way="any")
    yield from move_along(self, {"right": poses}, speed=0.12)           # through all of (k, 4, 4) without a stop
    yield from turn_hand(self, "right", np.deg2rad(30))                 # about the vertical through the fingertips
    gap = yield from close_gripper(self, "right", force=30.0)           # what is left between the fingertips [m]
    yield from open_gripper(self, "right")
    yield from look_towards(self, point)                                # pans the head

Speeds are of the `hand` point [m/s]; near the person the guard slows every motion down by itself.  Poses that
cannot be reached raise Unreachable or MotionBlocked, which a skill passes on as its reason.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping
from typing import Literal

import numpy as np

from ...sim.robot import model
from ...sim.robot.collision import CollisionChecker
from ...sim.robot.kinematics import default_kinematics, planar_pose
from ...sim.world import SIDES, GripperOpening, JointTrajectory, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..motion.errors import MotionError
from ..motion.ik import FreeAxis, solve_ik
from ..motion.reach import plan_arms, plan_hand_line, plan_reach
from ..motion.trajectory import plan_joint_motion
from .follow import follow, joint_values

Way = Literal["line", "any", "either"]
Speed = float | Callable[[np.ndarray], float]  # a limit [m/s], or one by the hand's place (3,)
SPEED = 0.4  # of a hand away from the person [m/s]
OPEN = model.GRIPPER_STROKE
_RESTS = 0.0005  # fingers that move less than this from tick to tick have come to rest [m]


def hand_now(skill: Skill, side: Side) -> np.ndarray:
    """Pose (4, 4) of a hand in the map, from the joint angles."""
    seen = skill.world.observe()
    return default_kinematics().pose_hand_in_map(side, seen.arm_positions[SIDES.index(side)], seen.pose_base_in_map)


def cloth_load(skill: Skill, side: Side) -> np.ndarray:
    """Force (3,) on a hand, in the map [N]."""
    return skill.world.observe().wrench_hand_in_map[SIDES.index(side), :3]


def collision_checker(skill: Skill) -> CollisionChecker:
    """The run's checker of the arms against the robot itself and the bed."""
    bed = skill.world.room.bed
    return skill.context.memory.of(CollisionChecker, lambda: CollisionChecker(default_kinematics(), bed[None]))


def until_taut(skill: Skill, side: Side, load: float, motion: Iterator[None]) -> Iterator[None]:
    """Let `motion` go on until the cloth that the hand on `side` carries pulls harder than `load` [N].

    Raises:
        SkillFailure: MOTION_BLOCKED when the motion does not stop then, and whatever `motion` raises.
    """
    for _ in motion:
        if np.linalg.norm(cloth_load(skill, side)) > load:
            skill.world.stop()
            yield from skill.until(skill.context.guard.still, timeout=2.0, reason=Reason.MOTION_BLOCKED)
            return
        yield


def move_hands(
    skill: Skill,
    goals: Mapping[Side, np.ndarray],
    *,
    speed: Speed = SPEED,
    free: FreeAxis = "none",
    way: Way = "line",
    retreat: bool = False,
    patience: float = 2.0,
) -> Iterator[None]:
    """Bring one or both hands to poses.

    Args:
        skill: that moves.
        goals: by side, pose (4, 4) in the map.
        speed: greatest speed of each hand [m/s].
        free: hand axis about which the orientation does not matter (see `solve_ik`).
        way: `line` straight and turning evenly; `any` way that is free; `either` straight where that is possible.
        retreat: the motion takes load off the person, so the guard lets it pass at any load.
        patience: how long the arms may lag behind at the end [s].

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    seen = skill.world.observe()

    def plan(planner) -> JointTrajectory:
        return planner(
            default_kinematics(),
            goals,
            seen.arm_positions,
            seen.pose_base_in_map,
            free=free,
            hand_speed=speed,
            checker=collision_checker(skill),
        )

    if way == "any":
        trajectory = plan(plan_reach)
    else:
        try:
            trajectory = plan(plan_hand_line)
        except MotionError:
            if way == "line":
                raise
            trajectory = plan(plan_reach)
    yield from follow(skill, trajectory, retreat=retreat, patience=patience)


def move_along(
    skill: Skill,
    paths: Mapping[Side, np.ndarray],
    *,
    speed: float = SPEED,
    free: FreeAxis = "none",
    retreat: bool = False,
) -> Iterator[None]:
    """Lead hands through poses without a stop; `paths` by side (k, 4, 4), a few centimetres apart, the same k.

    Raises:
        MotionError: a pose is out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    seen, kinematics = skill.world.observe(), default_kinematics()
    waypoints: dict[Side, np.ndarray] = {}
    for side, poses in paths.items():
        path = [seen.arm_positions[SIDES.index(side)]]
        for pose in poses:
            path.append(solve_ik(kinematics, side, pose, seen.pose_base_in_map, path[-1], free=free, seeds=2))
        waypoints[side] = np.array(path)
    resting = [n for n, side in enumerate(SIDES) if side not in paths]
    trajectory = plan_joint_motion(
        kinematics,
        waypoints,
        seen.pose_base_in_map,
        hand_speed=speed,
        checker=collision_checker(skill),
        other_arm=seen.arm_positions[resting[0]] if resting else None,
    )
    yield from follow(skill, trajectory, retreat=retreat)


def move_arms(
    skill: Skill, target: np.ndarray, *, sides: tuple[Side, ...] = SIDES, speed: Speed = SPEED, retreat: bool = False
) -> Iterator[None]:
    """Bring the arms on `sides` to joint angles `target` (2, 7) [rad], such as `model.READY`, by a free way."""
    seen = skill.world.observe()
    trajectory = plan_arms(
        default_kinematics(),
        target,
        seen.arm_positions,
        seen.pose_base_in_map,
        sides=sides,
        hand_speed=speed,
        checker=collision_checker(skill),
    )
    yield from follow(skill, trajectory, retreat=retreat)


def turn_hand(skill: Skill, side: Side, angle: float, *, speed: float = SPEED) -> Iterator[None]:
    """Turn a hand by `angle` [rad] about the vertical through its fingertips, which stay where they are."""
    pose = hand_now(skill, side)
    turned = pose.copy()
    turned[:3, :3] = planar_pose(np.array((0.0, 0.0, angle)))[:3, :3] @ pose[:3, :3]
    yield from move_hands(skill, {side: turned}, speed=speed)


def open_gripper(skill: Skill, side: Side, opening: float = OPEN, *, timeout: float = 3.0) -> Iterator[None]:
    """Open the fingers to `opening` [m] and wait for it; the hand then holds nothing.

    Raises:
        SkillFailure: COMMAND_LOST when they are not open after `timeout` [s].
    """
    n = SIDES.index(side)
    skill.world.send(GripperOpening(side=side, opening=opening), retreat=True)
    yield from skill.until(
        lambda: skill.world.observe().gripper_opening[n] > opening - 0.004, timeout=timeout, reason=Reason.COMMAND_LOST
    )
    skill.context.guard.declare_grip(side, "nothing")


def close_gripper(
    skill: Skill, side: Side, *, opening: float = 0.0, force: float = 30.0, timeout: float = 3.0
) -> Generator[None, None, float]:
    """Close the fingers until they rest on what is between them, or on each other.

    Args:
        skill: that grasps.
        side: which hand.
        opening: where to stop at the latest [m].
        force: greatest squeezing force [N].
        timeout: when to give up [s].

    Returns:
        What is left between the fingertips [m]; the caller says by `declare_grip` what that is.

    Raises:
        SkillFailure: COMMAND_LOST when the fingers never moved, GRASP_MISSED when they never rest.
    """
    n = SIDES.index(side)
    before = start = float(skill.world.observe().gripper_opening[n])
    skill.world.send(GripperOpening(side=side, opening=opening, force_limit=force))
    end, calm, moved = skill.now() + timeout, 0, False
    while calm < 2:
        if skill.now() >= end:
            if moved:
                raise SkillFailure(Reason.GRASP_MISSED, f"the {side} fingers do not come to rest")
            raise SkillFailure(Reason.COMMAND_LOST, f"the {side} fingers do not close")
        yield
        gap = float(skill.world.observe().gripper_opening[n])
        moved = moved or gap < start - 0.002 or start <= opening + 0.002
        calm = calm + 1 if abs(gap - before) < _RESTS and moved else 0
        before = gap
    return before


def look_towards(skill: Skill, point_in_map: np.ndarray, *, tolerance: float = 0.03) -> Iterator[None]:
    """Pan the head so that `point_in_map` (2,) or (3,) lies in the middle of the image's width."""
    seen = skill.world.observe()
    x, y, yaw = seen.pose_base_in_map
    neck = planar_pose(seen.pose_base_in_map)[:3, :3] @ model.TORSO_IN_BASE + (x, y, 0.0)
    wanted = np.arctan2(point_in_map[1] - neck[1], point_in_map[0] - neck[0]) - yaw
    yield from pan_head(skill, float((wanted + np.pi) % (2 * np.pi) - np.pi), tolerance=tolerance)


def pan_head(skill: Skill, angle: float, *, tolerance: float = 0.03) -> Iterator[None]:
    """Turn the head to `angle` [rad], positive to the left, as far as the neck can."""
    low, high = default_kinematics().head_range
    here, angle = float(joint_values(skill.world.observe(), ("head_pan",))[0]), float(np.clip(angle, low, high))
    if abs(angle - here) <= tolerance:
        return
    duration = 1.5 * abs(angle - here) / model.HEAD_VELOCITY + 0.2  # a smooth motion peaks at 1.5 of its mean speed
    yield from follow(
        skill,
        JointTrajectory(joints=("head_pan",), times=np.array((0.0, duration)), positions=np.array(((here,), (angle,)))),
        tolerance=tolerance,
    )

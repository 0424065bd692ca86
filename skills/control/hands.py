"""Hands, fingers and head in motion: generators that skills use with `yield from`.

    yield from move_hands(self, {"right": pose})                        # straight, poses (4, 4) in the map
    yield from move_hands(self, {"left": a, "right": b}, speed=0.5, way="any")
    gap = yield from close_gripper(self, "right", force=30.0)           # what is left between the fingertips [m]
    yield from open_gripper(self, "right")
    yield from look_towards(self, point)                                # pans the head

Speeds are of the `hand` point [m/s]; near the person the guard slows every motion down by itself.  Poses that
cannot be reached raise Unreachable or MotionBlocked, which a skill passes on as its reason.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.robot import model
from ...sim.robot.collision import CollisionChecker
from ...sim.robot.gripper import GRIPPER
from ...sim.robot.kinematics import default_kinematics, planar_pose
from ...sim.world import SIDES, GripperOpening, JointTrajectory, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..motion.errors import MotionError
from ..motion.ik import FreeAxis
from ..motion.reach import plan_arms, plan_hand_line, plan_reach
from .follow import FOLLOW, follow, joint_values

Way = Literal["line", "any", "either"]
Speed = float | Callable[[np.ndarray], float]  # a limit [m/s], or one by the hand's position (3,) in the map


@dataclass(frozen=True, kw_only=True)
class HandsTuning(Quantities):
    """Numbers of moving hands, fingers and the head."""

    speed: float = quantity(0.4, "m/s", "of a hand away from the person", "choice: near the person the guard slows it")
    stop_timeout: float = quantity(
        2.0, "s", "for a motion to stop once the cloth pulls too hard", "choice: far longer than arms take to brake"
    )
    open_tolerance: float = quantity(
        0.004, "m", "short of the opening that was asked for at which the fingers are open", "choice: half a finger"
    )
    grip_force: float = quantity(30.0, "N", "of squeezing cloth, at most", "choice: thin cloth is held without a slip")
    gripper_timeout: float = quantity(3.0, "s", "for the fingers to open or close", "choice: five times what they take")
    min_closing: float = quantity(0.002, "m", "of the fingers that counts as motion", "choice: above the noise")
    rest_change: float = quantity(
        0.0005, "m", "from tick to tick below which the fingers rest", "choice: a few per cent of their speed"
    )
    rest_ticks: int = quantity(2, "1", "ticks in a row in which the fingers must rest", "choice: one may be chance")
    pan_tolerance: float = quantity(0.03, "rad", "of the head's angle", "choice: a small part of the picture's width")
    pan_time: float = quantity(0.2, "s", "more than the head's speed asks for", "choice: it starts and stops gently")
    pan_peak: float = quantity(
        1.5, "1", "greatest speed of a smooth motion, as a multiple of its mean", "design: that of a cubic polynomial"
    )


HANDS = HandsTuning()


def hand_now(skill: Skill, side: Side) -> np.ndarray:
    """Pose (4, 4) of a hand in the map, from the joint angles."""
    seen = skill.world.observe()
    return default_kinematics().pose_hand_in_map(side, seen.arm_positions[SIDES.index(side)], seen.pose_base_in_map)


def cloth_load(skill: Skill, side: Side) -> np.ndarray:
    """Force (3,) in the map that the cloth, or whatever it holds, exerts on a hand [N]."""
    return skill.world.observe().wrench_hand_in_map[SIDES.index(side), :3]


def collision_checker(skill: Skill) -> CollisionChecker:
    """The run's checker of the arms against the robot itself and the bed."""
    bed = skill.world.room.bed
    return skill.context.memory.of(CollisionChecker, lambda: CollisionChecker(default_kinematics(), bed[None]))


def until_load(
    skill: Skill, side: Side, max_load: float, motion: Iterator[None], *, tuning: HandsTuning = HANDS
) -> Iterator[None]:
    """Let `motion` go on until the cloth that one hand carries pulls too hard, then stop it.

    Args:
        skill: that moves.
        side: of the hand that carries the cloth.
        max_load: that ends the motion [N].
        motion: of that hand.
        tuning: how long stopping may take.

    Raises:
        SkillFailure: MOTION_BLOCKED when the motion does not stop then, and whatever `motion` raises.
    """
    for _ in motion:
        if np.linalg.norm(cloth_load(skill, side)) > max_load:
            skill.world.stop()
            still = skill.context.guard.still
            yield from skill.until(still, timeout=tuning.stop_timeout, reason=Reason.MOTION_BLOCKED)
            return
        yield


def move_hands(
    skill: Skill,
    goals: Mapping[Side, np.ndarray],
    *,
    speed: Speed = HANDS.speed,
    free: FreeAxis = "none",
    way: Way = "line",
    retreat: bool = False,
    patience: float = FOLLOW.patience,
) -> Iterator[None]:
    """Bring one or both hands to poses.

    Args:
        skill: that moves.
        goals: by side, pose (4, 4) in the map.
        speed: greatest speed of each hand [m/s], or a function of its position (3,) in the map.
        free: hand axis about which the orientation does not matter (see `solve_ik`).
        way: `line` straight and turning evenly; `any` way that is free; `either` straight where that is possible.
        retreat: the motion takes load off the person, so the guard lets it pass at any load.
        patience: how long the arms may lag behind at the end [s].

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    seen = skill.world.observe()

    def plan(planner: Callable[..., JointTrajectory]) -> JointTrajectory:
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


def move_arms(
    skill: Skill,
    target: np.ndarray,
    *,
    sides: tuple[Side, ...] = SIDES,
    speed: Speed = HANDS.speed,
    retreat: bool = False,
) -> Iterator[None]:
    """Bring arms to joint angles by a free way.

    Args:
        skill: that moves.
        target: (2, 7) joint angles, such as `model.READY` [rad].
        sides: that move; the other row of `target` does not count.
        speed: greatest speed of each hand [m/s], or a function of its position (3,) in the map.
        retreat: the motion takes load off the person.

    Raises:
        MotionError: something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
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


def open_gripper(
    skill: Skill,
    side: Side,
    opening: float = GRIPPER.stroke,
    *,
    timeout: float = HANDS.gripper_timeout,
    tuning: HandsTuning = HANDS,
) -> Iterator[None]:
    """Open the fingers and wait for it; the hand then holds nothing.

    Args:
        skill: that opens them.
        side: which hand.
        opening: between the fingertips [m].
        timeout: when to give up [s].
        tuning: how far they may be from it.

    Raises:
        SkillFailure: COMMAND_LOST when they are not open in time.
    """
    n = SIDES.index(side)
    skill.world.send(GripperOpening(side=side, opening=opening), retreat=True)
    yield from skill.until(
        lambda: skill.world.observe().gripper_opening[n] > opening - tuning.open_tolerance,
        timeout=timeout,
        reason=Reason.COMMAND_LOST,
    )
    skill.context.guard.declare_grip(side, "nothing")


def close_gripper(
    skill: Skill,
    side: Side,
    *,
    opening: float = 0.0,
    force: float = HANDS.grip_force,
    timeout: float = HANDS.gripper_timeout,
    tuning: HandsTuning = HANDS,
) -> Generator[None, None, float]:
    """Close the fingers until they rest on what is between them, or on each other.

    Args:
        skill: that grasps.
        side: which hand.
        opening: where to stop at the latest [m].
        force: greatest squeezing force [N].
        timeout: when to give up [s].
        tuning: when the fingers move, and when they rest.

    Returns:
        What is left between the fingertips [m]; the caller says by `declare_grip` what that is.

    Raises:
        SkillFailure: COMMAND_LOST when the fingers never moved, GRASP_MISSED when they never rest.
    """
    n = SIDES.index(side)
    before = start = float(skill.world.observe().gripper_opening[n])
    skill.world.send(GripperOpening(side=side, opening=opening, force_limit=force))
    end, calm, moved = skill.now() + timeout, 0, False
    while calm < tuning.rest_ticks:
        if skill.now() >= end:
            if moved:
                raise SkillFailure(Reason.GRASP_MISSED, f"the {side} fingers do not come to rest")
            raise SkillFailure(Reason.COMMAND_LOST, f"the {side} fingers do not close")
        yield
        gap = float(skill.world.observe().gripper_opening[n])
        moved = moved or gap < start - tuning.min_closing or start <= opening + tuning.min_closing
        calm = calm + 1 if abs(gap - before) < tuning.rest_change and moved else 0
        before = gap
    return before


def look_towards(skill: Skill, point_in_map: np.ndarray, *, tolerance: float = HANDS.pan_tolerance) -> Iterator[None]:
    """Pan the head so that `point_in_map` (2,) or (3,) lies in the middle of the image's width."""
    seen = skill.world.observe()
    x, y, yaw = seen.pose_base_in_map
    neck = planar_pose(seen.pose_base_in_map)[:3, :3] @ model.TORSO_IN_BASE + (x, y, 0.0)
    wanted = np.arctan2(point_in_map[1] - neck[1], point_in_map[0] - neck[0]) - yaw
    yield from pan_head(skill, float((wanted + np.pi) % (2 * np.pi) - np.pi), tolerance=tolerance)


def pan_head(
    skill: Skill, angle: float, *, tolerance: float = HANDS.pan_tolerance, tuning: HandsTuning = HANDS
) -> Iterator[None]:
    """Turn the head to `angle` [rad], positive to the left, as far as the neck can."""
    low, high = default_kinematics().head_range
    here, angle = float(joint_values(skill.world.observe(), ("head_pan",))[0]), float(np.clip(angle, low, high))
    if abs(angle - here) <= tolerance:
        return
    duration = tuning.pan_peak * abs(angle - here) / model.HEAD_VELOCITY + tuning.pan_time
    yield from follow(
        skill,
        JointTrajectory(joints=("head_pan",), times=np.array((0.0, duration)), positions=np.array(((here,), (angle,)))),
        tolerance=tolerance,
    )

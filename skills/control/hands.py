"""Hands in motion: generators that skills use with `yield from`.

    yield from move_hands(self, {"right": pose})  # straight, poses (4, 4) in the map
    yield from move_hands(self, {"left": a, "right": b}, speed=0.5, way="any")
    yield from move_arms(self, self.world.robot.ready)

Speeds are of the `hand` point [m/s]; near the person the guard slows every motion down by itself.  Poses that
cannot be reached raise Unreachable or MotionBlocked, which a skill passes on as its reason.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...sim.mechanics.capsules import RobotCapsules
from ...sim.mechanics.collision import CollisionChecker
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.quantity import Quantities, quantity
from ...sim.segments import segment_distances
from ...sim.world import SIDES, JointTrajectory, Side
from ..core.reasons import Reason
from ..core.skill import Skill
from ..motion.clear_of_person import ClearOfPerson
from ..motion.errors import MotionError
from ..motion.ik import FreeAxis
from ..motion.reach import plan_arms, plan_hand_line, plan_reach, plan_straight_reach
from ..motion.trajectory import HandSpeed
from .follow import FOLLOW, follow

Way = Literal["line", "any", "either"]
WAYS: dict[Way, tuple[Callable[..., JointTrajectory], ...]] = {  # tried one after the other
    "line": (plan_hand_line,),
    "any": (plan_reach,),
    "either": (plan_hand_line, plan_straight_reach, plan_reach),
}


@dataclass(frozen=True, kw_only=True)
class HandsTuning(Quantities):
    """Numbers of moving hands."""

    speed: float = quantity(0.4, "m/s", "of a hand away from the person", "choice: near the person the guard slows it")
    stop_timeout: float = quantity(
        2.0, "s", "for a motion to stop once the cloth pulls too hard", "choice: far longer than arms take to brake"
    )


HANDS = HandsTuning()


def hand_now(skill: Skill, side: Side) -> np.ndarray:
    """Pose (4, 4) of a hand in the map, from the joint angles."""
    seen, kinematics = skill.world.observe(), kinematics_of(skill.world.robot)
    return kinematics.pose_hand_in_map(side, seen.arm_positions[SIDES.index(side)], seen.pose_base_in_map)


def gap_between_arms(skill: Skill) -> float:
    """How far the robot's arms are from each other, at their nearest; below 0 they would be in each other [m]."""
    links = skill.context.memory.of(RobotCapsules, lambda: RobotCapsules(kinematics_of(skill.world.robot)))
    seen = skill.world.observe()
    ends = links.ends(seen.pose_base_in_map, seen.arm_positions, seen.head_pan, seen.gripper_opening)
    left, right = (np.array([name.startswith(side) for name in links.names]) for side in SIDES)
    distances, _ = segment_distances(ends[left], ends[right])
    return float((distances - links.radii[left][:, None] - links.radii[right]).min())


def cloth_load(skill: Skill, side: Side) -> np.ndarray:
    """Force (3,) in the map that the cloth, or whatever it holds, exerts on a hand [N]."""
    return skill.world.observe().wrench_hand_in_map[SIDES.index(side), :3]


def collision_checker(skill: Skill) -> CollisionChecker:
    """The run's checker of the arms against the robot itself, the bed, and the person as it is tracked now."""
    bed, guard, kinematics = skill.world.room.bed, skill.context.guard, kinematics_of(skill.world.robot)
    checker = skill.context.memory.of(CollisionChecker, lambda: CollisionChecker(kinematics, bed[None]))
    links = skill.context.memory.of(RobotCapsules, lambda: RobotCapsules(kinematics))
    return ClearOfPerson(checker, links, guard.zone, dict(guard.held_arms()), skill.world.observe())


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
    speed: HandSpeed = HANDS.speed,
    free: FreeAxis = "none",
    way: Way = "line",
    retreat: bool = False,
    patience: float = FOLLOW.patience,
) -> Iterator[None]:
    """Bring one or both hands to poses.

    Args:
        skill: that moves.
        goals: by side, pose (4, 4) in the map.
        speed: greatest speed of each hand [m/s], or a function of positions (k, 3) in the map, as `careful` makes.
        free: hand axis about which the orientation does not matter (see `solve_ik`).
        way: `line` straight and turning evenly; `any` way that is free; `either` straight where that is possible,
            turning evenly or else as the joints would have it.
        retreat: the motion takes load off the person, so the guard lets it pass at any load.
        patience: how long the arms may lag behind at the end [s].

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    seen = skill.world.observe()

    def plan(planner: Callable[..., JointTrajectory]) -> JointTrajectory:
        return planner(
            kinematics_of(skill.world.robot),
            goals,
            seen.arm_positions,
            seen.pose_base_in_map,
            free=free,
            hand_speed=speed,
            checker=collision_checker(skill),
        )

    *first, last = WAYS[way]
    for planner in first:
        with suppress(MotionError):
            trajectory = plan(planner)
            break
    else:
        trajectory = plan(last)
    yield from follow(skill, trajectory, retreat=retreat, patience=patience)


def move_arms(
    skill: Skill,
    target: np.ndarray,
    *,
    sides: tuple[Side, ...] = SIDES,
    speed: HandSpeed = HANDS.speed,
    retreat: bool = False,
) -> Iterator[None]:
    """Bring arms to joint angles by a free way.

    Args:
        skill: that moves.
        target: (2, n) joint angles, such as `robot.ready` [rad].
        sides: that move; the other row of `target` does not count.
        speed: greatest speed of each hand [m/s], or a function of positions (k, 3) in the map, as `careful` makes.
        retreat: the motion takes load off the person.

    Raises:
        MotionError: something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    seen = skill.world.observe()
    trajectory = plan_arms(
        kinematics_of(skill.world.robot),
        target,
        seen.arm_positions,
        seen.pose_base_in_map,
        sides=sides,
        hand_speed=speed,
        checker=collision_checker(skill),
    )
    yield from follow(skill, trajectory, retreat=retreat)

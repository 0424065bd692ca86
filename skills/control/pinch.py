"""Taking hold of cloth with two fingers: come up with them open, go in around it, close, and see what is held.

    yield from reach_in(self, "right", point.position_in_map, point.approach_in_map, point.closing_in_map)
    yield from pinch(self, "right")
    yield from back_off(self, "right")          # the way it came

Thin cloth leaves no gap between closed fingers, so what is held is seen by the camera of the hand.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...perception.errors import PerceptionFailure, Problem
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, GripperOpening, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..core.tries import Tries
from ..motion.errors import Unreachable
from ..motion.ik import hand_pose, solve_ik
from ..motion.trajectory import free_postures
from .fingers import FINGERS, close_gripper, let_cloth_go, open_gripper
from .hands import HANDS, collision_checker, hand_now, move_hands, until_load


@dataclass(frozen=True, kw_only=True)
class PinchTuning(Quantities):
    """Numbers of taking hold of cloth."""

    depth: float = quantity(
        0.017, "m", "of the fingertips beyond the edge of the cloth", "choice: almost half of the finger pads' length"
    )
    standoff: float = quantity(
        0.12,
        "m",
        "from the cloth to the fingertips that wait open",
        "choice: the open fingers clear it",
    )
    inwards_share: float = quantity(
        0.5, "1", "of the speed on the straight way in", "choice: what the fingers touch is pushed away less"
    )
    touch_speed: float = quantity(
        0.025,
        "m/s",
        "of the fingertips on that way right beside the person",
        "choice: at 0.05 m/s a hand met a leg with 96 N (163), at 0.11 m/s with 296 N (166)",
    )
    touch_distance: float = quantity(
        0.04, "m", "of the fingertips from the person, below which they go so slowly", "choice: they are 0.06 m apart"
    )
    touch_load: float = quantity(
        8.0,
        "N",
        "on a hand on that way, which ends it: it has met the person",
        "choice: more than sensors err by; hands that went on met a leg with 89 N (118) and the trunk with 95 N (124)",
    )
    min_confidence: float = quantity(
        0.15, "1", "from which the fingers are taken to hold cloth", "choice: thin cloth shows little between them"
    )
    rolls: tuple[float, ...] = quantity(
        tuple(math.radians(roll) for roll in (0, 180, 30, -30, 210, 150, 60, -60, 240, 120, 90, -90)),
        "rad",
        "about the approach, tried in turn",
        "choice: the wanted one first, and each beside the one turned by half a turn, as the fingers are alike",
    )
    seeds: int = quantity(5, "1", "starting points of inverse kinematics for each roll", "choice: many rolls are tried")
    seeds_onwards: int = quantity(2, "1", "starting points for the straight way in", "choice: it begins nearby")


PINCH = PinchTuning()


def reach_in(
    skill: Skill,
    side: Side,
    position: np.ndarray,
    approach: np.ndarray,
    closing: np.ndarray,
    *,
    opening: float | None = None,
    standoff: float = PINCH.standoff,
    depth: float = PINCH.depth,
    speed: float = HANDS.speed,
    tuning: PinchTuning = PINCH,
) -> Iterator[None]:
    """Bring open fingers around the edge of cloth, at first in front of it and then straight in, or until they touch.

    Args:
        skill: that grasps.
        side: which hand.
        position: (3,) of the cloth in the map [m].
        approach: (3,) unit vector from the hand to the cloth.
        closing: (3,) along which the fingers should close; the nearest roll that the arm can take is used.
        opening: of the fingers on the way in, as far as they go by default [m].
        standoff: where to begin the straight way [m].
        depth: how far the fingertips go beyond the position [m].
        speed: of the hand until it waits in front of the cloth; less of it on the straight way [m/s].
        tuning: rolls of the hand that are tried, how much slower the straight way is, and what ends it.

    Raises:
        MotionError: out of reach.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    before, inside = grasp_poses(
        skill, side, position, approach, closing, standoff=standoff, depth=depth, tuning=tuning
    )
    wide = skill.world.robot.gripper.stroke if opening is None else opening
    skill.world.send(GripperOpening(side=side, opening=wide), retreat=True)
    yield from move_hands(skill, {side: before}, speed=speed, way="any")
    yield from open_gripper(skill, side, wide)
    slower, zone = tuning.inwards_share * speed, skill.context.guard.zone

    def inwards(places: np.ndarray) -> np.ndarray:
        return np.where(zone.distance(places) < tuning.touch_distance, min(slower, tuning.touch_speed), slower)

    yield from until_load(skill, side, tuning.touch_load, move_hands(skill, {side: inside}, speed=inwards))


def grasp_poses(
    skill: Skill,
    side: Side,
    position: np.ndarray,
    approach: np.ndarray,
    closing: np.ndarray,
    *,
    sweep: np.ndarray | float = 0.0,
    standoff: float = PINCH.standoff,
    depth: float = PINCH.depth,
    tuning: PinchTuning = PINCH,
) -> tuple[np.ndarray, np.ndarray]:
    """Hand poses (4, 4) in front of and around the cloth, with the first roll at which the arm reaches both.

    Arguments are those of `reach_in`; `sweep` (3,) is where the hand will go on from there [m].

    Raises:
        Unreachable: with no roll.
    """
    seen, n = skill.world.observe(), SIDES.index(side)
    kinematics, base = kinematics_of(skill.world.robot), seen.pose_base_in_map
    accept = free_postures(collision_checker(skill), side, base, seen.arm_positions)
    across = np.cross(approach, closing)
    tries = Tries(Unreachable)
    for roll in tuning.rolls:
        turned = math.cos(roll) * closing + math.sin(roll) * across
        before = hand_pose(position - standoff * approach, approach, turned)
        inside = hand_pose(position + depth * approach, approach, turned)
        with tries:
            q = solve_ik(
                kinematics,
                side,
                before,
                base,
                seen.arm_positions[n],
                seeds=tuning.seeds,
                accept=accept,
            )
            q = solve_ik(kinematics, side, inside, base, q, seeds=tuning.seeds_onwards, accept=accept)
            if np.any(sweep):
                swept = inside.copy()
                swept[:3, 3] += sweep
                solve_ik(kinematics, side, swept, base, q, seeds=tuning.seeds_onwards, accept=accept)
            return before, inside
    raise tries.last


def pinch(
    skill: Skill, side: Side, *, force: float = FINGERS.grip_force, tuning: PinchTuning = PINCH
) -> Iterator[None]:
    """Close the fingers and look whether cloth is between them.

    Raises:
        SkillFailure: GRASP_MISSED when nothing is, COMMAND_LOST when they do not close.
    """
    yield from close_gripper(skill, side, force=force)
    if holds_cloth(skill, side) < tuning.min_confidence:
        raise SkillFailure(Reason.GRASP_MISSED, f"the {side} hand's camera sees no cloth between the fingers")
    skill.context.guard.declare_grip(side, "cloth")


def pinch_or_back_off(skill: Skill, side: Side, *, force: float = FINGERS.grip_force) -> Iterator[None]:
    """`pinch` with `force` [N]; where nothing is between the fingers, they open and the hand draws back first.

    Raises:
        SkillFailure: as `pinch` does.
    """
    try:
        yield from pinch(skill, side, force=force)
    except SkillFailure as miss:
        if miss.reason == Reason.GRASP_MISSED:
            yield from let_cloth_go(skill, side)
            yield from back_off(skill, side)
            yield from open_gripper(skill, side)
        raise


def holds_cloth(skill: Skill, side: Side) -> float:
    """Confidence, 0 to 1, of the hand's camera that the fingers hold cloth; of the head's where cloth hides them."""
    for camera in (f"{side}_hand", "head"):
        frame = skill.world.look(camera)
        try:
            return skill.context.senses.gripped_cloth(frame, pose_hand_in_map=hand_now(skill, side)).confidence
        except PerceptionFailure as failure:
            if failure.problem != Problem.HIDDEN:
                break
    return 0.0


def back_off(
    skill: Skill, side: Side, distance: float = PINCH.standoff, *, speed: float = HANDS.speed
) -> Iterator[None]:
    """Draw a hand back along its own approach by `distance` [m].

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    pose = hand_now(skill, side)
    pose[:3, 3] -= distance * pose[:3, 2]
    yield from move_hands(skill, {side: pose}, speed=speed, way="either", retreat=True)

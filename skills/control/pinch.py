"""Taking hold of cloth with two fingers: come up with them open, go in around it, close, and see what is held.

    yield from reach_in(self, "right", point.position_in_map, point.approach_in_map, point.closing_in_map)
    yield from pinch(self, "right")
    yield from back_off(self, "right")          # the way it came

Thin cloth leaves no gap between closed fingers, so what is held is seen by the camera of the hand.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...perception.errors import PerceptionFailure
from ...sim.robot.kinematics import default_kinematics
from ...sim.world import SIDES, GripperOpening, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..core.tries import Tries
from ..motion.errors import Unreachable
from ..motion.ik import hand_pose, solve_ik
from ..motion.trajectory import free_postures
from .hands import OPEN, SPEED, close_gripper, collision_checker, hand_now, move_hands, open_gripper

DEPTH = 0.017  # of the cloth's edge between the finger pads, which are 38 mm long [m]
STANDOFF = 0.12  # from the cloth, where the fingers wait open [m]
SURE = 0.15  # confidence from which the fingers are taken to hold cloth
_ROLLS = np.deg2rad((0, 180, 30, -30, 210, 150, 60, -60, 240, 120, 90, -90))  # about the approach, best first


def reach_in(
    skill: Skill,
    side: Side,
    position: np.ndarray,
    approach: np.ndarray,
    closing: np.ndarray,
    *,
    opening: float = OPEN,
    standoff: float = STANDOFF,
    depth: float = DEPTH,
    speed: float = SPEED,
) -> Iterator[None]:
    """Bring open fingers around a place, at first in front of it and then straight in.

    Args:
        skill: that grasps.
        side: which hand.
        position: (3,) of the cloth in the map [m].
        approach: (3,) unit vector from the hand to the cloth.
        closing: (3,) along which the fingers should close; the nearest roll that the arm can take is used.
        opening: of the fingers on the way in [m].
        standoff: where to begin the straight way [m].
        depth: how far the fingertips go beyond the place [m].
        speed: of the hand until there; half of it on the straight way [m/s].

    Raises:
        MotionError: out of reach.
        SkillFailure: COMMAND_LOST or MOTION_BLOCKED.
    """
    before, inside = grasp_poses(skill, side, position, approach, closing, standoff=standoff, depth=depth)
    skill.world.send(GripperOpening(side=side, opening=opening), retreat=True)
    yield from move_hands(skill, {side: before}, speed=speed, way="any")
    yield from open_gripper(skill, side, opening)
    yield from move_hands(skill, {side: inside}, speed=speed / 2)


def grasp_poses(
    skill: Skill,
    side: Side,
    position: np.ndarray,
    approach: np.ndarray,
    closing: np.ndarray,
    *,
    sweep: np.ndarray | float = 0.0,
    standoff: float = STANDOFF,
    depth: float = DEPTH,
) -> tuple[np.ndarray, np.ndarray]:
    """Hand poses (4, 4) in front of and around the cloth, with the first roll at which the arm reaches both.

    Arguments are those of `reach_in`; `sweep` (3,) is where the hand will go on from there [m].

    Raises:
        Unreachable: with no roll.
    """
    seen, n = skill.world.observe(), SIDES.index(side)
    kinematics = default_kinematics()
    accept = free_postures(collision_checker(skill), side, seen.pose_base_in_map, seen.arm_positions)
    across = np.cross(approach, closing)
    tries = Tries(Unreachable)
    for roll in _ROLLS:
        turned = np.cos(roll) * closing + np.sin(roll) * across
        before = hand_pose(position - standoff * approach, approach, turned)
        inside = hand_pose(position + depth * approach, approach, turned)
        with tries:
            q = solve_ik(kinematics, side, before, seen.pose_base_in_map, seen.arm_positions[n], seeds=5, accept=accept)
            q = solve_ik(kinematics, side, inside, seen.pose_base_in_map, q, seeds=2, accept=accept)
            if np.any(sweep):
                swept = inside.copy()
                swept[:3, 3] += sweep
                solve_ik(kinematics, side, swept, seen.pose_base_in_map, q, seeds=2, accept=accept)
            return before, inside
    raise tries.last


def pinch(skill: Skill, side: Side, *, force: float = 30.0) -> Iterator[None]:
    """Close the fingers and look whether cloth is between them.

    Raises:
        SkillFailure: GRASP_MISSED when nothing is, COMMAND_LOST when they do not close.
    """
    yield from close_gripper(skill, side, force=force)
    if holds_cloth(skill, side) < SURE:
        raise SkillFailure(Reason.GRASP_MISSED, f"the {side} hand's camera sees no cloth between the fingers")
    skill.context.guard.declare_grip(side, "cloth")


def holds_cloth(skill: Skill, side: Side) -> float:
    """How sure the camera of the hand is that the fingers hold cloth, 0 to 1."""
    frame = skill.world.look(f"{side}_hand")
    try:
        return skill.context.senses.gripped_cloth(frame, pose_hand_in_map=hand_now(skill, side)).confidence
    except PerceptionFailure:
        return 0.0


def back_off(skill: Skill, side: Side, distance: float = STANDOFF, *, speed: float = SPEED) -> Iterator[None]:
    """Draw a hand back along its own approach by `distance` [m]."""
    pose = hand_now(skill, side)
    pose[:3, 3] -= distance * pose[:3, 2]
    yield from move_hands(skill, {side: pose}, speed=speed, way="either", retreat=True)

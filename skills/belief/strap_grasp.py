"""From where to take a strap: the way in that the arm can make, and from which it can then present the sleeve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...perception.estimates import SleeveOpening
from ...perception.image.cloud import unit
from ...sim.robot.kinematics import Kinematics, default_kinematics
from ...sim.world import SIDES, Side
from ..control.hands import collision_checker
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP, ArmPath
from ..geometry.stances import outwards, stance
from ..geometry.strap_grip import StrapGrip, presenting, strap_grip
from ..motion.errors import Unreachable
from ..motion.ik import hand_pose, solve_ik
from ..motion.trajectory import free_postures

DEPTH = 0.014  # of the fingertips below the cloth [m]
STANDOFF = 0.10  # the straight way in [m]
# From the fingertip to where the sleeve is presented first, as far as the arm reaches [m].  It swings out ahead.
BEYOND = (0.36, 0.30)
_TILTS = np.deg2rad((25.0, 40.0, 55.0, 72.0, 88.0))  # of the approach below the horizontal
_SIDEWAYS = np.deg2rad(30.0)  # the approach keeps at least this near to the robot's own direction
_PLACES = (3.3, 2.7, 2.1, 1.5, 1.0, 0.5, 0.0, -0.3)  # of the pull, at which its posture is tried
_ABOVE = 0.09  # of the gripper off the arm's axis while it pulls [m]
_LEAP = 1.3  # greatest change of a joint from one such place to the next [rad]
_ROOM = 0.15  # to the joint limits that will do [rad]
_BENT = 0.15  # what a radian of turning between grasp and presenting counts, in radians of room to the joint limits


@dataclass(frozen=True, kw_only=True)
class WayIn:
    """Hand poses (4, 4) in the map before and around a strap."""

    before: np.ndarray
    inside: np.ndarray


def presenting_place(path: ArmPath, beyond: float) -> np.ndarray:
    """(3,) place straight before the fingertips, where the sleeve is held towards the hand [m]."""
    return path.points[3] + beyond * unit(path.direction(2.5) * (1.0, 1.0, 0.0))


def way_in(skill: Skill, arm: Side, hand: Side, strap: SleeveOpening, path: ArmPath, *, worn: bool = False) -> WayIn:
    """The best way to take a strap.

    Args:
        skill: that asks.
        arm: the wearer's side of the sleeve.
        hand: that takes it.
        strap: where it is.
        path: of the arm that is to be dressed, where it is now.
        worn: the sleeve is over the hand already: it is pulled on from where it is.

    Raises:
        Unreachable: no way in leads to a grasp with which the sleeve could be presented, or pulled on.
    """
    seen, kinematics = skill.world.observe(), default_kinematics()
    n, base = SIDES.index(hand), seen.pose_base_in_map
    limits = kinematics.limits[hand]
    accept = free_postures(collision_checker(skill), hand, base, seen.arm_positions)
    found: list[tuple[float, WayIn, StrapGrip, np.ndarray]] = []
    tries = Tries(Unreachable)
    for approach in _approaches(strap, arm):
        for sign in (1.0, -1.0):
            inside = hand_pose(strap.position_in_map + DEPTH * approach, approach, sign * strap.closing_in_map)
            before = inside.copy()
            before[:3, 3] -= (DEPTH + STANDOFF) * approach
            grip = strap_grip(arm, hand, strap, inside)
            with tries:
                q0 = solve_ik(kinematics, hand, before, base, seen.arm_positions[n], seeds=6, accept=accept)
                q1 = solve_ik(kinematics, hand, inside, base, q0, seeds=2, accept=accept)
                q2 = q1 if worn else _presented(kinematics, grip, path, base, q1, accept)
                room = min(float(np.min(np.minimum(q - limits.lower, limits.upper - q))) for q in (q0, q1, q2))
                score = min(room, 0.4) - _BENT * float(np.abs(q2 - q1).max())
                found.append((score, WayIn(before=before, inside=inside), grip, q2))
    if not found:
        raise tries.last
    best: tuple[float, WayIn] | None = None
    begin = path.place_of(strap.position_in_map) if worn else np.inf
    for _, way, grip, q in sorted(found, key=lambda entry: -entry[0]):
        room = _room_to_pull(kinematics, grip, path, base, q, begin)
        if best is None or room > best[0]:
            best = (room, way)
        if room > _ROOM:
            break
    assert best is not None
    return best[1]


def _room_to_pull(
    kinematics: Kinematics, grip: StrapGrip, path: ArmPath, base: np.ndarray, q: np.ndarray, begin: float
) -> float:
    """Least room to a joint limit [rad] on the way from `begin` to the shoulder; -1 for each place not reached.

    The base drifts to where the shoulder is in reach on the second half of the way, as `PullAlongArm` does.
    """
    limits, room, lost = kinematics.limits[grip.hand], np.inf, 0
    stand = stance(grip.arm, "shoulder")
    for place in (place for place in _PLACES if place < begin):
        there = base + np.clip((1.5 - place) / 1.8, 0.0, 1.0) * (stand - base) * (1.0, 1.0, 0.0)
        pose = presenting(grip, path.direction(place), path.point(place) + _ABOVE * path.frame(place)[:, 2])
        try:
            reached = solve_ik(kinematics, grip.hand, pose, there, q, seeds=1)
        except Unreachable:
            lost += 1
            continue
        if np.abs(reached - q).max() > _LEAP:  # another posture, which the hand does not get to on its way
            lost += 1
            continue
        q = reached
        room = min(room, float(np.min(np.minimum(q - limits.lower, limits.upper - q))))
    return min(room, 1.0) - lost


def _presented(
    kinematics: Kinematics,
    grip: StrapGrip,
    path: ArmPath,
    base: np.ndarray,
    q: np.ndarray,
    accept: Callable[[np.ndarray], bool],
) -> np.ndarray:
    """Arm angles (7,) that present the sleeve as far out as can be reached."""
    tries = Tries(Unreachable)
    for beyond in BEYOND:
        pose = presenting(grip, path.direction(2.5), presenting_place(path, beyond))
        with tries:
            return solve_ik(kinematics, grip.hand, pose, base, q, seeds=6, accept=accept)
    raise tries.last


def _approaches(strap: SleeveOpening, arm: Side) -> list[np.ndarray]:
    """Unit vectors into the cloth, the one most square to it first, all from the robot's side and from above."""
    towards_bed = -outwards(arm)
    flat = strap.approach_in_map * (1.0, 1.0, 0.0)
    heading = unit(flat) if np.linalg.norm(flat) > 0.3 and flat @ towards_bed > 0.0 else towards_bed
    side = np.cross(UP, towards_bed)
    turn = np.clip(np.arctan2(heading @ side, heading @ towards_bed), -_SIDEWAYS, _SIDEWAYS)
    heading = np.cos(turn) * towards_bed + np.sin(turn) * side
    square = float(np.arctan2(-strap.approach_in_map[2], max(float(strap.approach_in_map @ heading), 1e-6)))
    tilts = sorted(_TILTS, key=lambda tilt: abs(tilt - square))
    return [np.cos(tilt) * heading - np.sin(tilt) * UP for tilt in tilts]

"""Choose how to take a strap: by an approach that the arm can make, and after which it can present the sleeve."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...perception.estimates import SleeveOpening
from ...perception.image.cloud import unit
from ...sim.mechanics.kinematics import Kinematics, kinematics_of
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Side
from ..control.hands import collision_checker
from ..control.pull_law import PullLaw
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP, ArmPath
from ..geometry.stances import outwards, stance
from ..geometry.strap_grip import StrapGrip, presenting, strap_grip
from ..motion.errors import Unreachable
from ..motion.ik import hand_pose, solve_ik
from ..motion.trajectory import free_postures


@dataclass(frozen=True, kw_only=True)
class StrapGraspTuning(Quantities):
    """Numbers of choosing how to take a strap."""

    depths: tuple[float, ...] = quantity(
        (0.014, 0.004),
        "m",
        "of the fingertips below the cloth, tried in turn",
        "choice: what lies behind it is not taken; the less deep where it lies right on the person",
    )
    standoff: float = quantity(0.10, "m", "length of the straight way in", "choice: the open fingers clear the cloth")
    presenting_distances: tuple[float, float] = quantity(
        (0.36, 0.30),
        "m",
        "from the fingertip to where the sleeve is held out, the first of them that the arm reaches",
        "choice: the sleeve swings out ahead",
    )
    tilts: tuple[float, float, float, float, float] = quantity(
        tuple(math.radians(tilt) for tilt in (25.0, 40.0, 55.0, 72.0, 88.0)),
        "rad",
        "of the approach below the horizontal, the one most square to the cloth first",
        "choice: from flat over the bed to straight down",
    )
    max_turn: float = quantity(
        math.radians(30.0),
        "rad",
        "of the approach about the vertical off the robot's side",
        "choice: the arm's own reach",
    )
    min_level: float = quantity(
        0.3, "1", "horizontal part of the cloth's normal that has a heading", "choice: a flatter strap has none"
    )
    seeds: int = quantity(6, "1", "starting points of inverse kinematics for a new pose", "choice: half of the usual")
    seeds_onwards: int = quantity(2, "1", "starting points for the straight way in", "choice: it begins nearby")
    max_room: float = quantity(
        0.4, "rad", "to the joint limits beyond which more does not count", "choice: then turning less is better"
    )
    turn_cost: float = quantity(
        0.15,
        "1",
        "room that a radian of turning between grasp and presenting costs",
        "choice: prefers to turn less",
    )
    pull_coordinates: tuple[float, ...] = quantity(
        (3.3, 2.7, 2.1, 1.5, 1.0, 0.5, 0.0, -0.3),
        "1",
        "arm coordinates of the pull at which its posture is tried",
        "choice: from before the hand to beyond the shoulder",
    )
    max_joint_step: float = quantity(
        1.3, "rad", "from one of them to the next", "choice: more is another posture, which the hand does not get to"
    )
    min_room: float = quantity(
        0.15, "rad", "to the joint limits that will do on the whole pull", "choice: ends the search"
    )
    drift_from: float = quantity(
        1.5,
        "1",
        "arm coordinate from which the base drifts to where the shoulder is in reach",
        "choice: like the pull",
    )
    drift_length: float = quantity(
        1.8, "1", "of the drift, in arm coordinates", "choice: it ends at the last of `pull_coordinates`"
    )


STRAP_GRASP = StrapGraspTuning()


@dataclass(frozen=True, kw_only=True)
class WayIn:
    """Hand poses before and around a strap.

    Attributes:
        before: (4, 4) in the map, where the open fingers wait.
        inside: (4, 4) in the map, where they close.
    """

    before: np.ndarray
    inside: np.ndarray


def presenting_position(path: ArmPath, beyond: float) -> np.ndarray:
    """(3,) position in the map `beyond` [m] the fingertip, level with it, where the sleeve is held towards the hand."""
    return path.points[3] + beyond * unit(path.hand_direction * (1.0, 1.0, 0.0))


def way_in(
    skill: Skill,
    arm: Side,
    hand: Side,
    strap: SleeveOpening,
    path: ArmPath,
    *,
    worn: bool = False,
    tuning: StrapGraspTuning = STRAP_GRASP,
) -> WayIn:
    """The best way to take a strap.

    Args:
        skill: that asks.
        arm: the wearer's side of the sleeve.
        hand: that takes it.
        strap: where it is.
        path: of the arm that is to be dressed, where it is now.
        worn: the sleeve is over the hand already: it is pulled on from where it is.
        tuning: numbers of the choice.

    Raises:
        Unreachable: no way in leads to a grasp with which the sleeve could be presented, or pulled on.
    """
    seen, kinematics = skill.world.observe(), kinematics_of(skill.world.robot)
    n, base = SIDES.index(hand), seen.pose_base_in_map
    limits = kinematics.limits[hand]
    accept = free_postures(collision_checker(skill), hand, base, seen.arm_positions)
    found: list[tuple[float, WayIn, StrapGrip, np.ndarray]] = []
    tries = Tries(Unreachable)
    for depth in tuning.depths:
        for approach, sign in product(_approaches(strap, arm, tuning), (1.0, -1.0)):
            inside = hand_pose(strap.position_in_map + depth * approach, approach, sign * strap.closing_in_map)
            before = inside.copy()
            before[:3, 3] -= (depth + tuning.standoff) * approach
            grip = strap_grip(arm, hand, strap, inside)
            with tries:
                q0 = solve_ik(kinematics, hand, before, base, seen.arm_positions[n], seeds=tuning.seeds, accept=accept)
                q1 = solve_ik(kinematics, hand, inside, base, q0, seeds=tuning.seeds_onwards, accept=accept)
                q2 = q1 if worn else _presented(kinematics, grip, path, base, q1, accept, tuning)
                room = min(limits.margin(q) for q in (q0, q1, q2))
                score = min(room, tuning.max_room) - tuning.turn_cost * float(np.abs(q2 - q1).max())
                found.append((score, WayIn(before=before, inside=inside), grip, q2))
        if found:
            break
    else:
        raise tries.last
    best: tuple[float, WayIn] | None = None
    begin = path.coordinate_of(strap.position_in_map) if worn else np.inf
    for _, way, grip, q in sorted(found, key=lambda entry: -entry[0]):
        room = _room_to_pull(kinematics, grip, path, base, q, begin, tuning)
        if best is None or room > best[0]:
            best = (room, way)
        if room > tuning.min_room:
            break
    assert best is not None
    return best[1]


def _room_to_pull(
    kinematics: Kinematics,
    grip: StrapGrip,
    path: ArmPath,
    base: np.ndarray,
    q: np.ndarray,
    begin: float,
    tuning: StrapGraspTuning,
) -> float:
    """Least room to a joint limit [rad] from arm coordinate `begin` to the shoulder; 1 less for each not reached.

    The base drifts to where the shoulder is in reach on the second half of the way, as `PullAlongArm` does.
    """
    limits, room, lost = kinematics.limits[grip.hand], np.inf, 0
    stand, clearance = stance(grip.arm, "shoulder"), PullLaw().clearance
    for coordinate in (one for one in tuning.pull_coordinates if one < begin):
        drift = np.clip((tuning.drift_from - coordinate) / tuning.drift_length, 0.0, 1.0)
        there = base + drift * (stand - base) * (1.0, 1.0, 0.0)
        position = path.point(coordinate) + clearance * path.frame(coordinate)[:, 2]
        pose = presenting(grip, path.direction(coordinate), position)
        try:
            reached = solve_ik(kinematics, grip.hand, pose, there, q, seeds=1)
        except Unreachable:
            lost += 1
            continue
        if np.abs(reached - q).max() > tuning.max_joint_step:
            lost += 1
            continue
        q = reached
        room = min(room, limits.margin(q))
    return min(room, 1.0) - lost  # one more that is reached counts more than any room


def _presented(
    kinematics: Kinematics,
    grip: StrapGrip,
    path: ArmPath,
    base: np.ndarray,
    q: np.ndarray,
    accept: Callable[[np.ndarray], bool],
    tuning: StrapGraspTuning,
) -> np.ndarray:
    """Arm angles (n,) that present the sleeve as far out as can be reached."""
    tries = Tries(Unreachable)
    for beyond in tuning.presenting_distances:
        pose = presenting(grip, path.hand_direction, presenting_position(path, beyond))
        with tries:
            return solve_ik(kinematics, grip.hand, pose, base, q, seeds=tuning.seeds, accept=accept)
    raise tries.last


def _approaches(strap: SleeveOpening, arm: Side, tuning: StrapGraspTuning) -> list[np.ndarray]:
    """Unit vectors into the cloth, the one most square to it first, all from the robot's side and from above."""
    towards_bed = -outwards(arm)
    flat = strap.approach_in_map * (1.0, 1.0, 0.0)
    heading = unit(flat) if np.linalg.norm(flat) > tuning.min_level and flat @ towards_bed > 0.0 else towards_bed
    side = np.cross(UP, towards_bed)
    turn = np.clip(math.atan2(heading @ side, heading @ towards_bed), -tuning.max_turn, tuning.max_turn)
    heading = math.cos(turn) * towards_bed + math.sin(turn) * side
    square = float(math.atan2(-strap.approach_in_map[2], max(float(strap.approach_in_map @ heading), 1e-6)))
    tilts = sorted(tuning.tilts, key=lambda tilt: abs(tilt - square))
    return [math.cos(tilt) * heading - math.sin(tilt) * UP for tilt in tilts]

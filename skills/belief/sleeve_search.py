"""Where a sleeve is seen from afar, and from where the hand's camera then looks at its strap.

The lifted arm stands before the sleeve and the robot's own hands hang over it, so a sleeve that was seen well is
remembered until somebody takes hold of it.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ...perception.errors import PerceptionFailure
from ...perception.estimates import SleeveOpening
from ...sim.robot import model
from ...sim.robot.kinematics import default_kinematics
from ...sim.world import SIDES, Side
from ..control.hands import look_towards, move_hands
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP
from ..geometry.hold import Hold
from ..geometry.stances import outwards
from ..motion.errors import MotionError
from ..motion.ik import hand_pose
from .person_tracking import careful, watch_arm

WELL = 0.4  # confidence of a sleeve whose strap shows; where it is hidden it has 0.2
DISTANCE, HIGH = 0.29, 0.42  # from the hand's camera to the strap it looks at; to a sleeve that it looks for [m]
RESTS = 0.15  # the camera comes to rest [s]
TO_STRAP = np.array((0.0, -0.05, 0.0))  # from an armhole to its strap, in a gown laid with its collar headward [m]
# The hand points that far below the horizontal when it looks, its camera 35 degrees less: at a sleeve that lies on
# the bed, and at one that hangs over its edge.
_LYING, _HANGING = np.deg2rad((97.0, 80.0, 65.0)), np.deg2rad((52.0, 68.0, 40.0))
_TURNS = np.deg2rad((0.0, 35.0, -35.0))  # about the vertical, off the robot's side
_HANGS = 0.03  # a sleeve this far below the mattress hangs over the edge [m]
_ELBOW, _FINGERTIP = 1, 3  # joints of the arm


@dataclass
class SeenWell:
    """Sleeves that were seen well and that nobody has taken hold of since, by the person's side.

    Attributes:
        sleeves: those.
        last: where each was seen last, well or badly (3,) [m].
    """

    sleeves: dict[Side, SleeveOpening] = field(default_factory=dict)
    last: dict[Side, np.ndarray] = field(default_factory=dict)


def seen_well(skill: Skill) -> dict[Side, SleeveOpening]:
    """The run's memory of sleeves; forget one with `pop` before it moves."""
    return skill.context.memory.of(SeenWell, SeenWell).sleeves


def find_sleeve(skill: Skill, side: Side, arm_in_map: np.ndarray) -> SleeveOpening:
    """The sleeve from afar: below the hand, where it was laid, by the elbow, after a miss, or where it was seen last.

    Where it does not show well, it is taken to lie where it was seen well before.

    Args:
        skill: that asks.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].

    Raises:
        PerceptionFailure: it is at neither place.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    frame, tries = skill.world.look("head"), Tries(PerceptionFailure)
    memory = skill.context.memory.of(SeenWell, SeenWell)
    nears = [arm_in_map[3] * (1.0, 1.0, 0.0) + skill.world.room.bed[1, 2] * UP, arm_in_map[1]]
    for near in [*nears, memory.last[side]] if side in memory.last else nears:
        with tries:
            seen = skill.context.senses.sleeve_opening(frame, side=side, near_in_map=near)
            memory.last[side] = seen.position_in_map
            if seen.confidence > WELL:
                memory.sleeves[side] = seen
            return memory.sleeves.get(side, seen)
    if side in memory.sleeves:
        return memory.sleeves[side]
    raise tries.first


def look_for_sleeve(
    skill: Skill, side: Side, hand: Side, *, hold: Hold | None = None, worn: bool = False
) -> Generator[None, None, SleeveOpening]:
    """As the head stands, then turned to the hand and to the elbow, then from above with the hand's camera.

    It ends where the sleeve shows well; else the best of these views counts.

    Args:
        skill: that looks.
        side: of the person.
        hand: whose camera looks from above, and which may move for that.
        hold: the hand that holds the arm meanwhile, or None.
        worn: the sleeve is over the person's hand already.

    Raises:
        PerceptionFailure: no view shows it.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale, or a motion failed.
    """
    best: SleeveOpening | None = None
    tries = Tries(PerceptionFailure)
    for place in (_ELBOW,) if worn else (None, _FINGERTIP, _ELBOW):
        if place is not None:
            yield from look_towards(skill, watch_arm(skill, side, hold=hold).points_in_map[place])
        with tries:
            seen = find_sleeve(skill, side, watch_arm(skill, side, hold=hold).points_in_map)
            best = seen if best is None or seen.confidence > best.confidence else best
            if best.confidence > WELL:
                return best
    if best is None:
        raise tries.first
    return best if worn else (yield from _from_above(skill, side, hand, best))


def _from_above(skill: Skill, side: Side, hand: Side, best: SleeveOpening) -> Generator[None, None, SleeveOpening]:
    """What the hand's camera sees of a sleeve that shows badly from the head, or that where it shows it no better."""
    for pose in strap_views(best, side, hand, skill.world.room.bed, HIGH):
        try:
            yield from move_hands(skill, {hand: pose}, way="any", speed=careful(skill, 0.5))
        except MotionError:
            continue
        yield from skill.wait(RESTS)
        try:
            seen = skill.context.senses.sleeve_opening(
                skill.world.look(f"{hand}_hand"), side=side, near_in_map=best.position_in_map
            )
        except PerceptionFailure:
            continue
        if seen.confidence > WELL:
            seen_well(skill)[side] = seen
            return seen
    return best


def strap_views(
    far: SleeveOpening, side: Side, hand: Side, bed: np.ndarray, distance: float = DISTANCE
) -> Iterator[np.ndarray]:
    """Hand poses (4, 4) from the robot's side whose camera has the strap in the middle, the best one first.

    Args:
        far: the sleeve as the head's camera sees it.
        side: of the person that the sleeve belongs to.
        hand: of the robot that looks.
        bed: (2, 3) lower and upper corner [m].
        distance: from the camera to the strap [m].
    """
    hangs = far.position_in_map[2] < bed[1, 2] - _HANGS
    camera, side_on = _camera_in_hand(hand), np.cross(UP, outwards(side))
    for turn, tilt in product(_TURNS, _HANGING if hangs else _LYING):
        towards_robot = np.cos(turn) * outwards(side) + np.sin(turn) * side_on
        pose = hand_pose(np.zeros(3), -np.cos(tilt) * towards_robot - np.sin(tilt) * UP, TO_STRAP)
        if (pose[:3, :3] @ camera[:3, 2]) @ towards_robot > pose[:3, 2] @ towards_robot:
            pose = pose @ np.diag((-1.0, -1.0, 1.0, 1.0))  # the camera's side of the hand towards the robot
        pose[:3, 3] = far.position_in_map + TO_STRAP - pose[:3, :3] @ (camera[:3, 3] + distance * camera[:3, 2])
        yield pose


def _camera_in_hand(hand: Side) -> np.ndarray:
    """Pose (4, 4) of a hand's camera in the hand's frame."""
    kinematics, n, base = default_kinematics(), SIDES.index(hand), np.zeros(3)
    camera = kinematics.pose_camera_in_map(f"{hand}_hand", base, model.READY, 0.0)
    return np.linalg.inv(kinematics.pose_hand_in_map(hand, model.READY[n], base)) @ camera

"""Find a sleeve from afar, and choose from where the hand's camera then looks at its strap.

The lifted arm and the robot's own hands hide the sleeve, so one that was seen well is remembered until a hand takes it.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ...perception.errors import PerceptionFailure
from ...perception.estimates import SleeveOpening
from ...sim.mechanics.robot_model import RobotModel
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..control.hand_view import camera_in_hand
from ..control.hands import move_hands
from ..control.head import look_towards
from ..core.skill import Skill
from ..core.tries import Tries
from ..geometry.arm_path import UP
from ..geometry.hold import Hold
from ..geometry.stances import HEADWARD, outwards
from ..motion.errors import MotionError
from ..motion.ik import half_turned, hand_pose
from .person_tracking import careful, watch_arm

_ELBOW, _FINGERTIP = 1, 3  # rows of the arm's points


@dataclass(frozen=True, kw_only=True)
class SleeveSearchTuning(Quantities):
    """Numbers of looking for a sleeve."""

    clear_confidence: float = quantity(
        0.4, "1", "of a sleeve whose strap shows", "choice: where the strap is hidden the estimator says 0.2"
    )
    strap_distance: float = quantity(
        0.29, "m", "from the hand's camera to a strap that it looks at", "choice: strap and armhole fill the picture"
    )
    search_distance: float = quantity(
        0.42, "m", "from the hand's camera to a sleeve that it looks for", "choice: more of the bed is in view"
    )
    settle_time: float = quantity(0.15, "s", "for the camera to come to rest", "choice: two ticks")
    speed: float = quantity(0.5, "m/s", "of the hand with the camera, away from the person", "choice: nothing is held")
    armhole_to_strap: float = quantity(
        0.05, "m", "headward from an armhole to its strap, in a laid gown", "choice: the gown's collar lies headward"
    )
    lying_tilts: tuple[float, float, float] = quantity(
        tuple(math.radians(tilt) for tilt in (97.0, 80.0, 65.0)),
        "rad",
        "of the hand below the horizontal as it looks at a sleeve that lies on the bed",
        "choice: its camera looks 35 degrees less steeply; the best view first",
    )
    hanging_tilts: tuple[float, float, float] = quantity(
        tuple(math.radians(tilt) for tilt in (52.0, 68.0, 40.0)),
        "rad",
        "the same for a sleeve that hangs over the edge",
        "choice: the best view first",
    )
    turns: tuple[float, float, float] = quantity(
        tuple(math.radians(turn) for turn in (0.0, 35.0, -35.0)),
        "rad",
        "of the view about the vertical, off the robot's side",
        "choice: what is in the way straight on may not be from aside",
    )
    hang_depth: float = quantity(
        0.03, "m", "below the mattress from which a sleeve hangs over the edge", "choice: more than the mattress gives"
    )


SLEEVE_SEARCH = SleeveSearchTuning()


@dataclass
class SleeveMemory:
    """Sleeves that were seen, by the person's side.

    Attributes:
        sleeves: those that were seen well and that no hand has taken since.
        last: where each was seen last, well or badly (3,) [m].
    """

    sleeves: dict[Side, SleeveOpening] = field(default_factory=dict)
    last: dict[Side, np.ndarray] = field(default_factory=dict)


def seen_well(skill: Skill) -> dict[Side, SleeveOpening]:
    """The run's memory of sleeves; forget one with `pop` before it moves."""
    return skill.context.memory.of(SleeveMemory, SleeveMemory).sleeves


def find_sleeve(
    skill: Skill, side: Side, arm_in_map: np.ndarray, *, tuning: SleeveSearchTuning = SLEEVE_SEARCH
) -> SleeveOpening:
    """The sleeve as the head sees it: below the hand (laid there), by the elbow (after a miss), or where it was last.

    Where it does not show well, it is taken to lie where it was seen well before.

    Args:
        skill: that asks.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: when it is seen well.

    Raises:
        PerceptionFailure: it is nowhere there.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    frame, tries = skill.world.look("head"), Tries(PerceptionFailure)
    memory = skill.context.memory.of(SleeveMemory, SleeveMemory)
    nears = [arm_in_map[3] * (1.0, 1.0, 0.0) + skill.world.room.bed[1, 2] * UP, arm_in_map[1]]
    for near in [*nears, memory.last[side]] if side in memory.last else nears:
        with tries:
            seen = skill.context.senses.sleeve_opening(frame, side=side, near_in_map=near)
            memory.last[side] = seen.position_in_map
            if seen.confidence > tuning.clear_confidence:
                memory.sleeves[side] = seen
            return memory.sleeves.get(side, seen)
    if side in memory.sleeves:
        return memory.sleeves[side]
    raise tries.first


def look_for_sleeve(
    skill: Skill,
    side: Side,
    hand: Side,
    *,
    hold: Hold | None = None,
    worn: bool = False,
    tuning: SleeveSearchTuning = SLEEVE_SEARCH,
) -> Generator[None, None, SleeveOpening]:
    """Look as the head stands, then turned to the hand and to the elbow, then from above with the hand's camera.

    The search ends where the sleeve shows well; else the best of these views counts.

    Args:
        skill: that looks.
        side: of the person.
        hand: whose camera looks from above, and which may move for that.
        hold: the hand that holds the arm meanwhile, or None.
        worn: the sleeve is over the person's hand already.
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: no view shows it.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale, or a motion failed.
    """
    best: SleeveOpening | None = None
    tries = Tries(PerceptionFailure)
    for joint in (_ELBOW,) if worn else (None, _FINGERTIP, _ELBOW):
        if joint is not None:
            yield from look_towards(skill, watch_arm(skill, side, hold=hold).points_in_map[joint])
        with tries:
            seen = find_sleeve(skill, side, watch_arm(skill, side, hold=hold).points_in_map, tuning=tuning)
            best = seen if best is None or seen.confidence > best.confidence else best
            if best.confidence > tuning.clear_confidence:
                return best
    if best is None:
        raise tries.first
    return best if worn else (yield from _from_above(skill, side, hand, best, tuning))


def _from_above(
    skill: Skill, side: Side, hand: Side, best: SleeveOpening, tuning: SleeveSearchTuning
) -> Generator[None, None, SleeveOpening]:
    """A sleeve that shows badly from the head, as the hand's camera sees it; `best` where that shows it no better."""
    for pose in strap_views(
        skill.world.robot, best, side, hand, skill.world.room.bed, tuning.search_distance, tuning=tuning
    ):
        try:
            yield from move_hands(skill, {hand: pose}, way="any", speed=careful(skill, tuning.speed))
        except MotionError:
            continue
        yield from skill.wait(tuning.settle_time)
        try:
            seen = skill.context.senses.sleeve_opening(
                skill.world.look(f"{hand}_hand"), side=side, near_in_map=best.position_in_map
            )
        except PerceptionFailure:
            continue
        if seen.confidence > tuning.clear_confidence:
            seen_well(skill)[side] = seen
            return seen
    return best


def strap_position(far: SleeveOpening, *, tuning: SleeveSearchTuning = SLEEVE_SEARCH) -> np.ndarray:
    """(3,) where in the map the strap of a sleeve is whose armhole was seen, the gown's collar headward [m]."""
    return far.position_in_map + tuning.armhole_to_strap * HEADWARD


def strap_views(
    robot: RobotModel,
    far: SleeveOpening,
    side: Side,
    hand: Side,
    bed: np.ndarray,
    distance: float = SLEEVE_SEARCH.strap_distance,
    *,
    tuning: SleeveSearchTuning = SLEEVE_SEARCH,
) -> Iterator[np.ndarray]:
    """Hand poses (4, 4) in the map, from the robot's side, whose camera has the strap in the middle, best one first.

    Args:
        robot: that looks.
        far: the sleeve as the head's camera sees it.
        side: of the person that the sleeve belongs to.
        hand: of the robot that looks.
        bed: (2, 3) lower and upper corner in the map [m].
        distance: from the camera to the strap [m].
        tuning: the angles of view.
    """
    hangs = far.position_in_map[2] < bed[1, 2] - tuning.hang_depth
    to_strap = tuning.armhole_to_strap * HEADWARD
    camera, side_on = camera_in_hand(robot, hand), np.cross(UP, outwards(side))
    for turn, tilt in product(tuning.turns, tuning.hanging_tilts if hangs else tuning.lying_tilts):
        towards_robot = math.cos(turn) * outwards(side) + math.sin(turn) * side_on
        pose = hand_pose(np.zeros(3), -math.cos(tilt) * towards_robot - math.sin(tilt) * UP, to_strap)
        if (pose[:3, :3] @ camera[:3, 2]) @ towards_robot > pose[:3, 2] @ towards_robot:
            pose = half_turned(pose)  # the camera's side of the hand towards the robot
        pose[:3, 3] = far.position_in_map + to_strap - pose[:3, :3] @ (camera[:3, 3] + distance * camera[:3, 2])
        yield pose

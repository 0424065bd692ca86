"""Lowering an arm that a hand holds, about its shoulder, until it lies."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...perception.errors import PerceptionFailure
from ...perception.estimates import ArmPosture
from ...perception.image.cloud import unit
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, HandTwist, SensorLost, Side
from ..belief.person_tracking import keep_with_hand, posture_in_hand, see_person, take_from_hand, watch_arm, watch_of
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..geometry.arm_path import UP, ArmPath
from ..geometry.hold import Hold
from ..geometry.stances import HEADWARD, outwards
from .arm_grip import lost_arm
from .compliant_hold import compliant_velocity
from .hands import cloth_load, hand_now


@dataclass(frozen=True, kw_only=True)
class LoweringTuning(Quantities):
    """How an arm is lowered, and when it lies.  Heights are above the mattress."""

    speed: float = quantity(0.045, "m/s", "of the hand on its way down", "choice: just below the guard's limit")
    lies_below: float = quantity(
        0.09,
        "m",
        "height of elbow, wrist and fingertip below which a tracked arm lies",
        "measured: arms at rest have theirs at 0.02 to 0.07; the tracker was off by at most 0.015 on the way down",
    )
    rest_height: float = quantity(
        0.04, "m", "of a hand around an arm that rests", "choice: the radius of a thin forearm"
    )
    aim_below: float = quantity(
        0.03,
        "m",
        "below that height, where the hand is bound",
        "choice: it passes that height and does not creep up to it",
    )
    edge: float = quantity(
        0.0, "m", "of a resting wrist from the edge of the mattress, at least", "choice: the hand may hang over it"
    )
    spread: float = quantity(
        0.0,
        "rad",
        "of the wrist away from the body in the end, about the shoulder, if it is not there already and the mattress "
        "is wide enough",
        "choice: straight down, unless who asks knows better",
    )
    aside_first: float = quantity(
        3.0,
        "1",
        "by which it is aimed higher for each part of its way aside that is left",
        "measured: aimed at where it rests, it lay before it was there: spread by 0.04 to 0.07 of 0.13 to 0.18 rad "
        "(149, 178)",
    )
    friction: float = quantity(
        0.0,
        "N",
        "pull square to the arm and its way that is borne: the joint that turns outwards resists",
        "choice: straight down, nothing resists but what has to be given way to",
    )
    turn_gain: float = quantity(0.6, "1/s", "of the hand's turn to straight down", "choice: turned before it is down")
    turn_rate: float = quantity(0.25, "rad/s", "of that turn, at most", "choice: the turn of a lift takes two seconds")
    slow_from: float = quantity(
        11.0, "N", "load against its way from which the hand slows down", "measured: stiff joints resist with up to 8 N"
    )
    stop_at: float = quantity(
        16.0,
        "N",
        "load against its way, or upward, at which it stands still",
        "choice: below the 18 N that the guard allows an open hand.  Of the upward load alone, an arm that cloth held "
        "aside was pressed with 48 N and slipped out of the fingers (164)",
    )
    stall_time: float = quantity(1.2, "s", "over which the way down is judged", "choice: dry friction sticks for less")
    stall_record: float = quantity(
        0.9, "1", "share of that time that must be on record for a judgement", "choice: ticks do not divide it evenly"
    )
    min_descent: float = quantity(
        0.01,
        "m",
        "within that time, down or else aside, of a hand that does not stand",
        "choice: a fifth of what full speed makes",
    )
    bed_load: float = quantity(
        10.0,
        "N",
        "upward load on a hand that stands, from which the bed carries the arm",
        "choice: between friction and `stop_at`",
    )
    max_rest_height: float = quantity(
        0.14, "m", "of a hand whose arm the bed may carry, at most", "choice: folds of a gown lie below the arm"
    )
    max_grip_distance: float = quantity(
        0.15, "m", "from a hand to the axis of the arm that it holds", "choice: the tracker is off by less"
    )
    timeout: float = quantity(25.0, "s", "for the way down", "choice: five times what a raised arm takes")
    cloth_load: float = quantity(
        2.5, "N", "on the other hand, from which it comes along", "choice: what it carries hangs on it with less"
    )
    cloth_compliance: float = quantity(
        0.03, "m/s/N", "speed of that for each newton above", "choice: as fast as the arm at twice that load"
    )
    cloth_speed: float = quantity(0.08, "m/s", "of that, at most", "choice: the forearm sinks no faster")


LOWERING = LoweringTuning()


def lies(skill: Skill, posture: ArmPosture, below: float = LOWERING.lies_below) -> bool:
    """Whether elbow, wrist and fingertip are seen `below` that height above the mattress [m]."""
    return bool(posture.points_in_map[1:, 2].max() < skill.world.room.bed[1, 2] + below)


def held_arm(skill: Skill, hand: Side, *, tuning: LoweringTuning = LOWERING) -> tuple[Side, Hold] | None:
    """The arm that runs between the fingers of a hand; None where neither memory nor a look has one there.

    An arm that the hand was said to hold when its owner moved is still there, found or not.
    """
    watch = watch_of(skill)
    if not watch.arms:
        with suppress(PerceptionFailure, SensorLost, SkillFailure):
            see_person(skill)  # they have moved, and nothing that was known is believed
    place, best = hand_now(skill, hand)[:3, 3], None
    for side, posture in watch.arms.items():
        away, coordinate = _along(posture, place)
        if best is None or away < best[0]:
            best = away, side, Hold(hand, coordinate)
    if best is not None and best[0] < tuning.max_grip_distance:
        return best[1:]
    for side, posture in watch.before.items():
        if side not in watch.arms and skill.context.guard.held_arms().get(hand) == f"{side} arm":
            return side, Hold(hand, _along(posture, place)[1])
    return None


def _along(posture: ArmPosture, place: np.ndarray) -> tuple[float, float]:
    """How far an arm's axis is from a place (3,) [m], and the arm coordinate there."""
    path = ArmPath.of(posture)
    coordinate = float(np.clip(path.coordinate_of(place), 0.0, 3.0))
    return float(np.linalg.norm(path.point(coordinate) - place)), coordinate


def resting_place(
    skill: Skill, side: Side, posture: ArmPosture, coordinate: float, *, tuning: LoweringTuning = LOWERING
) -> np.ndarray:
    """(3,) where a place of an arm comes to rest: about the shoulder, spread as asked, the wrist on the mattress."""
    bed, path = skill.world.room.bed, ArmPath.of(posture)
    shoulder = path.points[0]
    wrist, held = path.points[2] - shoulder, path.point(coordinate) - shoulder
    room = 0.5 * (bed[1, 0] - bed[0, 0]) - tuning.edge - (shoulder - bed.mean(axis=0)) @ outwards(side)
    widest = math.asin(np.clip(room / np.linalg.norm(wrist), 0.0, 1.0))
    wide, heading = _aside(wrist, side), _aside(held, side)
    heading += min(max(wide, tuning.spread), float(widest)) - wide
    reach = float(np.linalg.norm(held))
    rise = float(np.clip(bed[1, 2] + tuning.rest_height - shoulder[2], -0.9 * reach, 0.9 * reach))
    level = math.sin(heading) * outwards(side) - math.cos(heading) * HEADWARD
    return shoulder + np.sqrt(reach**2 - rise**2) * level + rise * UP


def lower_arm(
    skill: Skill, hand: Side, held: tuple[Side, Hold] | None, *, tuning: LoweringTuning = LOWERING
) -> Iterator[None]:
    """Swing a held arm down until it is seen to lie, the hand is at the mattress, the bed carries it, or it is lost.

    The hand goes about the shoulder, or straight down where that is not known, and gives way to what pulls across: so
    the arm finds its own circle.  Cloth that the other hand holds on the arm comes along.

    Args:
        skill: that lowers.
        hand: of the robot that holds the arm.
        held: which arm it holds where, None where that is not known.
        tuning: how it is lowered.

    Raises:
        SkillFailure: MOTION_BLOCKED when the hand stands too high, TIMEOUT; the arm is still held.
    """
    try:
        yield from _lower(skill, hand, held, tuning)
    except SkillFailure:
        if held:  # half way down, and soon let go of: nobody should look for it where it was held up
            keep_with_hand(skill, *held)
        raise


def _lower(skill: Skill, hand: Side, held: tuple[Side, Hold] | None, tuning: LoweringTuning) -> Iterator[None]:
    mattress = float(skill.world.room.bed[1, 2])
    downwards = _about_shoulder(skill, *held, tuning) if held else lambda position: (-UP, np.zeros(3))
    end, window = skill.now() + tuning.timeout, deque[tuple[float, np.ndarray]]()
    while True:
        pose, load = hand_now(skill, hand), cloth_load(skill, hand)
        height = float(pose[2, 3]) - mattress
        low = height < tuning.max_rest_height  # an arm that is held higher does not lie, whatever is seen
        at_rest = height < tuning.rest_height or (low and held is not None and _seen_to_lie(skill, *held, tuning))
        if lost_arm(skill, hand):
            return
        # the bed is stiff: pressed on for as long as a stall takes to be noticed, the guard's limit is passed
        at_rest |= low and float(load[2]) > tuning.stop_at
        if at_rest or carried_by_bed(window, skill.now(), pose[:3, 3] - mattress * UP, load, tuning):
            if held:
                with suppress(PerceptionFailure, SensorLost, SkillFailure):
                    take_from_hand(skill, *held)
            return
        if skill.now() > end:
            raise SkillFailure(Reason.TIMEOUT, f"the hand is {height:.2f} m above the mattress")
        along, square = downwards(pose[:3, 3])
        along = _not_against(along, load, tuning)
        against = max(float(load[2]), -float(load @ along))
        ease = float(np.clip((tuning.stop_at - against) / (tuning.stop_at - tuning.slow_from), 0.0, 1.0))
        down = tuning.speed * ease * along
        borne = float(np.clip(load @ square, -tuning.friction, tuning.friction)) * square
        linear = down + compliant_velocity(skill, hand, load - (load @ along) * along - borne)
        turn = tuning.turn_gain * np.cross(pose[:3, 2], -UP)
        turn *= min(1.0, tuning.turn_rate / max(float(np.linalg.norm(turn)), 1e-9))
        skill.world.send(HandTwist(side=hand, twist_in_map=np.append(linear, turn)), retreat=True)
        _bring_cloth(skill, hand, held, down, tuning)
        yield


def _about_shoulder(
    skill: Skill, side: Side, hold: Hold, tuning: LoweringTuning
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Unit vectors (3,) of a hand at a position (3,): its way about the shoulder, and square to that and the arm.

    It goes to where what it holds rests.
    """
    posture = posture_in_hand(skill, side, hold)
    assert posture is not None  # of an arm that was never found nobody knows that it is held
    shoulder = posture.points_in_map[0]
    goal = resting_place(skill, side, posture, hold.coordinate, tuning=tuning) - tuning.aim_below * UP - shoulder

    def along(position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        arm = unit(position - shoulder)
        left_aside = max(_aside(goal, side) - _aside(arm, side), 0.0) if tuning.spread else 0.0
        aim = goal + tuning.aside_first * left_aside * float(np.linalg.norm(goal)) * UP
        way = unit(aim - (aim @ arm) * arm)
        return way, np.cross(arm, way)

    return along


def _aside(arm: np.ndarray, side: Side) -> float:
    """Angle by which an arm (3,) points away from the body, along the bed [rad]."""
    return math.atan2(arm @ outwards(side), arm @ -HEADWARD)


def _not_against(along: np.ndarray, load: np.ndarray, tuning: LoweringTuning) -> np.ndarray:
    """The way (3,) without as much of it as goes level against what pushes (3,) [N]: the arm is held aside there."""
    level = load - (load @ UP) * UP
    push = unit(level)
    size = float(np.linalg.norm(level))
    share = float(np.clip((size - tuning.slow_from) / (tuning.stop_at - tuning.slow_from), 0.0, 1.0))
    return along - share * min(float(along @ push), 0.0) * push


def _seen_to_lie(skill: Skill, side: Side, hold: Hold, tuning: LoweringTuning) -> bool:
    """Whether the arm is seen to lie; without a picture the hand's own height has to do."""
    with suppress(PerceptionFailure, SensorLost, SkillFailure):
        return lies(skill, watch_arm(skill, side, hold=hold), tuning.lies_below)
    return False


def carried_by_bed(
    window: deque[tuple[float, np.ndarray]], now: float, place: np.ndarray, load: np.ndarray, tuning: LoweringTuning
) -> bool:
    """Whether the hand comes down no farther because the bed carries the arm; keeps the window of times and places.

    One that still goes aside does not stand: it goes there first, and began to come down after a second (0).

    Raises:
        SkillFailure: MOTION_BLOCKED where it is not the bed.
    """
    window.append((now, place))
    while window[0][0] < now - tuning.stall_time:
        window.popleft()
    on_record = now - window[0][0] > tuning.stall_record * tuning.stall_time
    height, (across, along, down) = float(place[2]), window[0][1] - place
    if not on_record or down > tuning.min_descent:
        return False
    if load[2] > tuning.bed_load and height < tuning.max_rest_height:
        return True
    if math.hypot(across, along) > tuning.min_descent:
        return False
    raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand stands {height:.2f} m above the mattress")


def _bring_cloth(
    skill: Skill, hand: Side, held: tuple[Side, Hold] | None, down: np.ndarray, tuning: LoweringTuning
) -> None:
    """A hand that holds cloth on the arm goes `down` (3,) with it [m/s], and follows what pulls at it.

    Left where it is, the hand that lowers the arm would have to pass through it.  Nearer to the shoulder the arm comes
    down by less: there a hand that went down as fast as the wrist pressed the upper arm with 27 to 32 N (101, 102).
    """
    other: Side = SIDES[1 - SIDES.index(hand)]
    load = cloth_load(skill, other)
    holds_cloth = skill.context.guard.grip(other) == "cloth"
    velocity = share_of_way(skill, hand, other, held) * down if holds_cloth else np.zeros(3)
    over = float(np.linalg.norm(load)) - tuning.cloth_load
    if over > 0.0:
        velocity = velocity + min(tuning.cloth_compliance * over, tuning.cloth_speed) * unit(load)
    if velocity.any():
        skill.world.send(HandTwist(side=other, twist_in_map=np.append(velocity, np.zeros(3))), retreat=True)


def share_of_way(skill: Skill, hand: Side, other: Side, held: tuple[Side, Hold] | None) -> float:
    """How far an arm comes down where the other hand is, as a share of the way of the hand that lowers it.

    Args:
        skill: that lowers.
        hand: of the robot that holds the arm.
        other: hand of the robot.
        held: which arm it holds where, None where that is not known.

    Returns:
        0 at the shoulder, 1 at the hand and beyond it, and where the arm is not known.
    """
    posture = None if held is None else posture_in_hand(skill, *held)
    if posture is None:
        return 1.0
    shoulder = posture.points_in_map[0]
    arm, cloth = (hand_now(skill, each)[:3, 3] - shoulder for each in (hand, other))
    return float(np.clip(cloth @ arm / max(float(arm @ arm), 1e-9), 0.0, 1.0))

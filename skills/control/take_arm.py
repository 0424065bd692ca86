"""Taking the person's arm from above: over it, down around it, fingers closed across it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, HandTwist, Side
from ..belief.person_tracking import careful
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from .arm_grip import ARM_GRIP
from .fingers import close_gripper, open_gripper
from .give_way import GiveWay, GiveWayTuning
from .hands import hand_now, move_hands, until_load


@dataclass(frozen=True, kw_only=True)
class TakeArmTuning(Quantities):
    """How a hand comes to an arm."""

    approach_speed: float = quantity(
        0.5, "m/s", "of the hand to above the arm, away from the person", "choice: quick in the open"
    )
    approach_height: float = quantity(
        0.12, "m", "of the open hand above the arm, before it goes down", "choice: clear of it"
    )
    grip_depth: float = quantity(
        0.005, "m", "of the fingertips below the arm's axis", "choice: the pads then reach round the arm's widest part"
    )
    descent_speed: float = quantity(
        0.05,
        "m/s",
        "of the hand down around the arm",
        "measured: at 0.12 m/s it came down on an arm that lay elsewhere under the gown with 121 to 123 N before the "
        "guard stopped it, four times (243)",
    )
    touch_speed: float = quantity(
        0.015,
        "m/s",
        "of the hand from where a finger may meet the arm",
        "measured: at 0.05 m/s one that came down on it pressed it with 28 N when first felt, 50 N a tick later, "
        "before the hand stood (101, 7 N/mm)",
    )
    touch_height: float = quantity(
        0.045, "m", "of the fingertips above the arm's axis, from where one may", "choice: an arm is 75 mm thick"
    )
    touch_load: float = quantity(
        8.0, "N", "on the hand on that way, which ends it: it has met something", "choice: as on the way to cloth"
    )
    tries: int = quantity(
        4, "1", "at getting round the arm, the first one included", "choice: with `sideways`, 18 mm to one side"
    )
    back: float = quantity(0.02, "m", "by which the hand goes up before it moves aside", "choice: off the arm")
    sideways: float = quantity(
        0.006,
        "m",
        "by which the hand moves to the side of the finger that met the arm",
        "choice: an arm 75 mm thick leaves 5 mm on either side in fingers that open by 85 mm",
    )
    across: float = quantity(
        0.3,
        "1",
        "share of the push along the approach from which what pushes the hand aside tells where the arm is",
        "choice: a finger that slides down its flank is pushed aside, one that stands on it is pushed up",
    )
    least_arm: float = quantity(
        0.015, "m", "of a push off the hand's middle, from which one finger has it", "choice: half way to a finger"
    )
    closing_speed: float = quantity(
        0.02,
        "m/s",
        "of the gap between the fingers, where they could close faster",
        "measured: closed as fast as they go, one hit an arm with 46 to 63 N that nothing carries (102), and pressed "
        "a stiff one with 36 N; so, with 25 N at first and none in the end (101, hard)",
    )
    aside_load: float = quantity(
        3.0, "N", "of one finger on the arm, from which the hand goes to its side", "choice: above the noise"
    )
    aside: GiveWayTuning = field(
        default_factory=lambda: GiveWayTuning(first=0.0002, most=0.0004)  # as fast as one finger closes under 30 N
    )
    reached: float = quantity(
        0.02, "m", "from the end of that way, within which it is around the arm", "choice: half of the pads' length"
    )


TAKE_ARM = TakeArmTuning()


def take_arm(skill: Skill, hand: Side, on_arm: np.ndarray, *, tuning: TakeArmTuning = TAKE_ARM) -> Iterator[None]:
    """Bring a hand over an arm and down, and close it; a hand that closes on nothing opens and goes up again.

    Args:
        skill: that moves.
        hand: of the robot.
        on_arm: pose (4, 4) in the map of a hand that points at the arm, its fingertips on the arm's axis.
        tuning: how it comes there.

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: GRASP_MISSED, COMMAND_LOST or MOTION_BLOCKED.
    """
    above, around = on_arm.copy(), on_arm.copy()
    above[:3, 3] -= tuning.approach_height * on_arm[:3, 2]
    around[:3, 3] += tuning.grip_depth * on_arm[:3, 2]
    yield from open_gripper(skill, hand)
    yield from move_hands(skill, {hand: above}, way="any", speed=careful(skill, tuning.approach_speed))
    yield from close_around(skill, hand, above, around, tuning=tuning)


def close_around(
    skill: Skill, hand: Side, above: np.ndarray, around: np.ndarray, *, tuning: TakeArmTuning = TAKE_ARM
) -> Iterator[None]:
    """Bring an open hand from `above` an arm down `around` it, and close it; where there is none, it goes up again.

    Args:
        skill: that moves.
        hand: of the robot.
        above: pose (4, 4) in the map in which it waits.
        around: pose (4, 4) in the map in which it closes.
        tuning: how it comes there.

    Raises:
        MotionError: out of reach, or something is in the way.
        SkillFailure: GRASP_MISSED, where it comes down on something or closes on nothing, COMMAND_LOST or
            MOTION_BLOCKED.
    """
    yield from _go_around(skill, hand, above, around, tuning)
    closing = close_gripper(skill, hand, force=ARM_GRIP.force, speed=tuning.closing_speed)
    gap = yield from _centred(skill, hand, closing, tuning)
    if gap < ARM_GRIP.min_gap:
        yield from open_gripper(skill, hand)
        yield from move_hands(skill, {hand: above}, retreat=True)
        raise SkillFailure(Reason.GRASP_MISSED, f"the fingers closed to {gap * 1000:.0f} mm: no arm between them")
    skill.context.guard.declare_grip(hand, "arm")


def _centred(
    skill: Skill, hand: Side, closing: Generator[None, None, float], tuning: TakeArmTuning
) -> Generator[None, None, float]:
    """Let fingers close, the hand going to the side of the one that meets the arm first: both then have it.

    A stiff arm was pressed by one finger with 30 to 36 N, until the guard stopped the hand (101, hard).
    """
    give_way = GiveWay(tuning.aside)
    while True:
        try:
            next(closing)
        except StopIteration as end:
            return end.value
        across = hand_now(skill, hand)[:3, 1]
        push = float(skill.world.observe().wrench_hand_in_map[SIDES.index(hand), :3] @ across)
        beyond = np.sign(push) * max(abs(push) - tuning.aside_load, 0.0) * across
        velocity = give_way.velocity(beyond, skill.now())
        if np.any(velocity):
            skill.world.send(HandTwist(side=hand, twist_in_map=np.append(velocity, np.zeros(3))), retreat=True)
        yield


def _go_around(
    skill: Skill, hand: Side, above: np.ndarray, around: np.ndarray, tuning: TakeArmTuning
) -> Iterator[None]:
    """Down, aside where one finger comes down on the arm and down again, until the arm is between the fingers.

    An arm is hardly thinner than the fingers open: seen 1 cm beside where it is, it was met six times of six (101).
    """
    goal, short = around.copy(), 0.0

    def speed(places: np.ndarray) -> np.ndarray:
        left = np.vecdot(goal[:3, 3] - places, goal[:3, 2])
        return np.where(left < tuning.touch_height + tuning.grip_depth, tuning.touch_speed, tuning.descent_speed)

    for n in range(tuning.tries):
        down = move_hands(skill, {hand: goal}, speed=speed)
        yield from until_load(skill, hand, tuning.touch_load, down)
        here = hand_now(skill, hand)
        short = float(np.linalg.norm(goal[:3, 3] - here[:3, 3]))
        if short <= tuning.reached:
            return
        towards = tuning.sideways * _side_that_met(skill, hand, here, tuning) * here[:3, 1]
        if not towards.any() or n == tuning.tries - 1:
            break
        skill.note("one finger has met the arm: aside, and down again")
        goal[:3, 3] += towards
        here[:3, 3] += towards - tuning.back * here[:3, 2]
        yield from move_hands(skill, {hand: here}, retreat=True)
    yield from move_hands(skill, {hand: above}, retreat=True)
    raise SkillFailure(Reason.GRASP_MISSED, f"the hand met something {short * 100:.0f} cm before it was round the arm")


def _side_that_met(skill: Skill, hand: Side, pose: np.ndarray, tuning: TakeArmTuning) -> float:
    """On which side of a hand at `pose` (4, 4) an arm pushes it: 1 or -1 along its closing direction, 0 for neither."""
    wrench = skill.world.observe().wrench_hand_in_map[SIDES.index(hand)]
    force, torque = wrench[:3] @ pose[:3, :3], wrench[3:] @ pose[:3, :3]
    if abs(force[1]) > tuning.across * abs(force[2]):
        return float(np.sign(force[1]))
    aside = torque[0] / force[2] if force[2] else 0.0
    return float(np.sign(aside)) if abs(aside) > tuning.least_arm else 0.0

"""Taking the person's arm from above: over it, down around it, fingers closed across it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..belief.person_tracking import careful
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from .arm_grip import ARM_GRIP
from .fingers import close_gripper, open_gripper
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
    touch_load: float = quantity(
        8.0, "N", "on the hand on that way, which ends it: it has met something", "choice: as on the way to cloth"
    )
    closing_speed: float = quantity(
        float("inf"),
        "m/s",
        "of the gap between the fingers, where they could close faster",
        "measured: an arm that nothing carries, 2 cm off their middle, was hit by one of them with 46 to 63 N (102)",
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
    down = move_hands(skill, {hand: around}, speed=tuning.descent_speed)
    yield from until_load(skill, hand, tuning.touch_load, down)
    short = float(np.linalg.norm(around[:3, 3] - hand_now(skill, hand)[:3, 3]))
    if short > tuning.reached:
        yield from move_hands(skill, {hand: above}, retreat=True)
        raise SkillFailure(
            Reason.GRASP_MISSED, f"the hand met something {short * 100:.0f} cm before it was round the arm"
        )
    gap = yield from close_gripper(skill, hand, force=ARM_GRIP.force, speed=tuning.closing_speed)
    if gap < ARM_GRIP.min_gap:
        yield from open_gripper(skill, hand)
        yield from move_hands(skill, {hand: above}, retreat=True)
        raise SkillFailure(Reason.GRASP_MISSED, f"the fingers closed to {gap * 1000:.0f} mm: no arm between them")
    skill.context.guard.declare_grip(hand, "arm")

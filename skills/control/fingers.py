"""Fingers in motion: generators that skills use with `yield from`.

gap = yield from close_gripper(self, "right", force=30.0)   # what is left between the fingertips [m]
yield from open_gripper(self, "right")
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, GripperOpening, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class FingersTuning(Quantities):
    """Numbers of moving fingers."""

    open_tolerance: float = quantity(
        0.004, "m", "short of the opening that was asked for at which the fingers are open", "choice: half a finger"
    )
    cloth_opening: float = quantity(
        0.035,
        "m",
        "of fingers that let cloth go right beside the person",
        "measured: opened wide, a finger pushed the shoulder with 68 N (104), and the chest with 67 to 82 N (156, 253, "
        "262)",
    )
    grip_force: float = quantity(30.0, "N", "of squeezing cloth, at most", "choice: thin cloth is held without a slip")
    timeout: float = quantity(3.0, "s", "for the fingers to open or close", "choice: five times what they take")
    min_closing: float = quantity(0.002, "m", "of the fingers that counts as motion", "choice: above the noise")
    meets: float = quantity(
        2.0, "N", "between fingers that stand open, from which something is between them", "choice: above the noise"
    )
    met_something: float = quantity(
        0.012, "m", "of fingers that close slowly behind where they should be", "choice: a few ticks of their way"
    )
    rest_change: float = quantity(
        0.0005, "m", "from tick to tick below which the fingers rest", "choice: a few per cent of their speed"
    )
    rest_ticks: int = quantity(2, "1", "ticks in a row in which the fingers must rest", "choice: one may be chance")


FINGERS = FingersTuning()


def open_gripper(
    skill: Skill,
    side: Side,
    opening: float | None = None,
    *,
    timeout: float = FINGERS.timeout,
    tuning: FingersTuning = FINGERS,
) -> Iterator[None]:
    """Open the fingers and wait for it; the hand then holds nothing.

    Args:
        skill: that opens them.
        side: which hand.
        opening: between the fingertips, as far as they go by default [m].
        timeout: when to give up [s].
        tuning: how far they may be from it.

    Raises:
        SkillFailure: COMMAND_LOST when they are not open in time.
    """
    n = SIDES.index(side)
    wide = skill.world.robot.gripper.stroke if opening is None else opening
    skill.world.send(GripperOpening(side=side, opening=wide), retreat=True)
    yield from skill.until(
        lambda: skill.world.observe().gripper_opening[n] > wide - tuning.open_tolerance,
        timeout=timeout,
        reason=Reason.COMMAND_LOST,
    )
    skill.context.guard.declare_grip(side, "nothing")


def let_cloth_go(skill: Skill, side: Side, *, tuning: FingersTuning = FINGERS) -> Iterator[None]:
    """Open the fingers just enough for cloth to slip out, and wait for it; ones that are open already stay so.

    Raises:
        SkillFailure: COMMAND_LOST when they are not open in time.
    """
    now = float(skill.world.observe().gripper_opening[SIDES.index(side)])
    yield from open_gripper(skill, side, max(now, tuning.cloth_opening), tuning=tuning)


def close_gripper(
    skill: Skill,
    side: Side,
    *,
    opening: float = 0.0,
    force: float = FINGERS.grip_force,
    speed: float = float("inf"),
    timeout: float = FINGERS.timeout,
    tuning: FingersTuning = FINGERS,
) -> Generator[None, None, float]:
    """Close the fingers until they rest on what is between them, or on each other.

    Args:
        skill: that grasps.
        side: which hand.
        opening: where to stop at the latest [m].
        force: greatest squeezing force [N].
        speed: at which the gap shrinks until it meets something, as fast as they go by default [m/s]: what lies loosely
            between the fingers is then brought to their middle, not hit by one of them.
        timeout: when to give up, from when they have met something [s].
        tuning: when the fingers move, and when they rest.

    Returns:
        What is left between the fingertips [m]; the caller says by `declare_grip` what that is.

    Raises:
        SkillFailure: COMMAND_LOST when the fingers never moved and felt nothing, GRASP_MISSED when they never rest or
            something keeps them open.
    """
    n = SIDES.index(side)
    before = start = float(skill.world.observe().gripper_opening[n])
    if speed < float("inf"):
        yield from _narrow(skill, side, opening, force, speed, tuning)
        before = float(skill.world.observe().gripper_opening[n])
    skill.world.send(GripperOpening(side=side, opening=opening, force_limit=force))
    end, calm, moved, felt = skill.now() + timeout, 0, False, 0.0
    while calm < tuning.rest_ticks:
        if skill.now() >= end:
            if moved:
                raise SkillFailure(Reason.GRASP_MISSED, f"the {side} fingers do not come to rest")
            if felt > tuning.meets:
                raise SkillFailure(Reason.GRASP_MISSED, f"something keeps the {side} fingers open with {felt:.0f} N")
            raise SkillFailure(Reason.COMMAND_LOST, f"the {side} fingers do not close")
        yield
        seen = skill.world.observe()
        gap, felt = float(seen.gripper_opening[n]), max(felt, float(seen.gripper_force[n]))
        moved = moved or gap < start - tuning.min_closing or start <= opening + tuning.min_closing
        calm = calm + 1 if abs(gap - before) < tuning.rest_change and moved else 0
        before = gap
    return before


def _narrow(
    skill: Skill, side: Side, opening: float, force: float, speed: float, tuning: FingersTuning
) -> Iterator[None]:
    """Close the fingers slowly to `opening` [m], or until they lag behind what they are told."""
    n = SIDES.index(side)
    wanted, last = float(skill.world.observe().gripper_opening[n]), skill.now()
    while wanted > opening:
        wanted, last = max(wanted - speed * (skill.now() - last), opening), skill.now()
        skill.world.send(GripperOpening(side=side, opening=wanted, force_limit=force))
        yield
        if float(skill.world.observe().gripper_opening[n]) > wanted + tuning.met_something:
            return

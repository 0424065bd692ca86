"""Letting the person's arm go: open, up and away from it, ready if asked to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..belief.person_tracking import careful
from ..core.skill import Skill
from .fingers import open_gripper
from .hands import move_arms
from .ready import ready_or_not
from .withdraw import WithdrawTuning, withdraw


@dataclass(frozen=True, kw_only=True)
class LetArmGoTuning(Quantities):
    """How a hand leaves an arm."""

    distance: float = quantity(
        0.16, "m", "by which the open hand draws back before it goes anywhere else", "choice: clear of the arm"
    )
    withdraw: WithdrawTuning = field(default_factory=WithdrawTuning)
    ready_speed: float = quantity(
        0.5, "m/s", "of the hand on its way to the ready posture, away from the person", "choice: quick in the open"
    )


def let_arm_go(skill: Skill, hand: Side, ready: str, *, tuning: LetArmGoTuning = LetArmGoTuning()) -> Iterator[None]:
    """Open a hand and draw it back, whether it holds an arm or not.

    Args:
        skill: that moves.
        hand: of the robot.
        ready: one of `ready.Ready`: whether the hand then goes to its ready posture.
        tuning: how it leaves.

    Raises:
        SkillFailure: a command was lost, or the motion did not come to rest.
        MotionError: no way to the ready posture was found where it has to go there.
    """

    def leave(ready: bool) -> Iterator[None]:
        skill.note("lets the arm go")
        yield from open_gripper(skill, hand)
        yield from withdraw(skill, [hand], tuning.distance, tuning.withdraw)
        if ready:
            speed = careful(skill, tuning.ready_speed)
            yield from move_arms(skill, skill.world.robot.ready, sides=(hand,), speed=speed, retreat=True)

    yield from ready_or_not(skill, ready, leave)

"""Letting the person's arm go: no longer pressed by it, open, up and away from it, ready if asked to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, HandTwist, Side
from ..belief.person_tracking import careful
from ..core.skill import Skill
from .arm_grip import holds_arm
from .compliant_hold import compliant_velocity
from .fingers import open_gripper
from .hands import move_arms
from .ready import ready_or_not
from .withdraw import WithdrawTuning, withdraw


@dataclass(frozen=True, kw_only=True)
class LetArmGoTuning(Quantities):
    """How a hand leaves an arm."""

    pressed: float = quantity(
        9.0,
        "N",
        "of an arm aside or upwards on the hand that holds it, above which the hand gives way before it opens",
        "measured: of 36 hands that let an arm go 32 felt less, and left with their fingers beside it; one that felt "
        "16 N left with a finger 1 cm in the arm (0)",
    )
    easing: float = quantity(3.0, "s", "for giving way, at most", "choice: 16 N were 2 cm of the arm's way (0)")
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
        yield from _give_way(skill, hand, tuning)
        yield from open_gripper(skill, hand)
        yield from withdraw(skill, [hand], tuning.distance, tuning.withdraw)
        if ready:
            speed = careful(skill, tuning.ready_speed)
            yield from move_arms(skill, skill.world.robot.ready, sides=(hand,), speed=speed, retreat=True)

    yield from ready_or_not(skill, ready, leave)


def _give_way(skill: Skill, hand: Side, tuning: LetArmGoTuning) -> Iterator[None]:
    """Until an arm hardly presses the hand that holds it: the finger that it presses would stay in it as it opens.

    What hangs on the hand is no reason: it is carried until the fingers open.
    """
    end = skill.now() + tuning.easing
    while holds_arm(skill, hand) and skill.now() < end:
        push = skill.world.observe().wrench_hand_in_map[SIDES.index(hand), :3].copy()
        push[2] = max(push[2], 0.0)
        if np.linalg.norm(push) <= tuning.pressed:
            return
        velocity = compliant_velocity(skill, hand, push)
        skill.world.send(HandTwist(side=hand, twist_in_map=np.append(velocity, np.zeros(3))), retreat=True)
        yield

"""Drawing open hands back from what they held, without a plan: safe from any state."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import HandTwist, Side
from ..core.skill import Skill
from ..geometry.arm_path import UP
from .hands import hand_now


@dataclass(frozen=True, kw_only=True)
class WithdrawTuning(Quantities):
    """How hands are drawn back."""

    speed: float = quantity(0.12, "m/s", "of the hands", "choice: below the guard's limit near the person")
    min_rise: float = quantity(
        0.3,
        "1",
        "upward part of the way back; where it is less, the hand goes straight up",
        "choice: a hand that lies flat clears the person upwards only",
    )
    patience: float = quantity(
        2.0, "1", "times what that takes, for a hand that is slower", "choice: near a joint's limit it is"
    )
    tolerance: float = quantity(0.015, "m", "of the way that may be left", "choice: hands start and stop smoothly")
    settle_time: float = quantity(0.3, "s", "waited in the end", "choice: the last command runs out")


def withdraw(
    skill: Skill, sides: Sequence[Side], distance: float, tuning: WithdrawTuning = WithdrawTuning()
) -> Iterator[None]:
    """Draw hands back against the way they point, or straight up where that way back does not rise.

    Args:
        skill: that moves.
        sides: of the robot.
        distance: of the way back [m].
        tuning: how they are drawn back.
    """
    directions, starts = {}, {}
    for side in sides:
        pose = hand_now(skill, side)
        back, starts[side] = -pose[:3, 2], pose[:3, 3]
        directions[side] = back if back[2] > tuning.min_rise else UP
    takes = distance / tuning.speed
    end, latest = skill.now() + takes, skill.now() + tuning.patience * takes

    def goes_on(side: Side) -> bool:
        way = float((hand_now(skill, side)[:3, 3] - starts[side]) @ directions[side])
        return skill.now() < end or (skill.now() < latest and way < distance - tuning.tolerance)

    while going := [side for side in directions if goes_on(side)]:
        for side in going:
            twist = np.append(tuning.speed * directions[side], np.zeros(3))
            skill.world.send(HandTwist(side=side, twist_in_map=twist), retreat=True)
        yield
    yield from skill.wait(tuning.settle_time)

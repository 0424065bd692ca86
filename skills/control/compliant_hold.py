"""While one hand holds the person's arm and the other works: the holding hand gives way instead of pulling.

Usage: `yield from while_holding(self, hold, move_hands(self, {"right": pose}))`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, HandTwist, Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..geometry.hold import Hold
from .arm_grip import lost_arm
from .give_way import GiveWay


@dataclass(frozen=True, kw_only=True)
class CompliantHoldTuning(Quantities):
    """How a hand that holds an arm gives way."""

    dead_band: float = quantity(6.0, "N", "pull that is borne", "choice: keeps the arm where it is held")
    arm_weight: float = quantity(20.0, "N", "more that is borne downwards", "choice: an arm's weight hangs on the hand")
    max_speed: float = quantity(0.03, "m/s", "greatest speed of giving way", "choice: harmless near the person")


COMPLIANT_HOLD = CompliantHoldTuning()


def while_holding(
    skill: Skill, hold: Hold | None, motion: Iterator[None], *, tuning: CompliantHoldTuning = COMPLIANT_HOLD
) -> Iterator[None]:
    """Let `motion` go on, and ease the hold on every tick.

    Args:
        skill: that moves.
        hold: the hand that holds the arm, or None.
        motion: of the other hand, the base or the head.
        tuning: how the holding hand gives way.

    Raises:
        SkillFailure: ARM_SLIPPED, and whatever `motion` raises.
    """
    for _ in motion:
        ease_hold(skill, hold, tuning=tuning)
        yield


def ease_hold(skill: Skill, hold: Hold | None, *, tuning: CompliantHoldTuning = COMPLIANT_HOLD) -> None:
    """Give way to the pull of the held arm, which is stiff: millimetres make many newtons.

    Args:
        skill: that moves.
        hold: the hand that holds the arm, or None, which does nothing.
        tuning: how the hand gives way.

    Raises:
        SkillFailure: ARM_SLIPPED when the hand no longer holds the arm.
    """
    if hold is None:
        return
    if lost_arm(skill, hold.hand):
        raise SkillFailure(Reason.ARM_SLIPPED, f"the {hold.hand} fingers have closed")
    load = skill.world.observe().wrench_hand_in_map[SIDES.index(hold.hand), :3]
    velocity = compliant_velocity(skill, hold.hand, load, tuning=tuning)
    if np.any(velocity):
        skill.world.send(HandTwist(side=hold.hand, twist_in_map=np.append(velocity, np.zeros(3))), retreat=True)


def compliant_velocity(
    skill: Skill, hand: Side, load: np.ndarray, *, tuning: CompliantHoldTuning = COMPLIANT_HOLD
) -> np.ndarray:
    """Velocity (3,) [m/s] with which a holding hand follows a load.

    Args:
        skill: that moves.
        hand: of the robot.
        load: (3,) on it in the map [N].
        tuning: what is borne.
    """
    pull = np.array(load, float)
    pull[2] = min(pull[2] + tuning.arm_weight, 0.0) if pull[2] < 0.0 else pull[2]
    size = float(np.linalg.norm(pull))
    hands = skill.context.memory.of(_GivingHands, _GivingHands).hands
    velocity = hands[hand].velocity(max(size - tuning.dead_band, 0.0) / max(size, 1e-9) * pull, skill.now())
    return velocity * min(1.0, tuning.max_speed / max(float(np.linalg.norm(velocity)), 1e-9))


@dataclass
class _GivingHands:
    hands: dict[Side, GiveWay] = field(default_factory=lambda: {side: GiveWay() for side in SIDES})

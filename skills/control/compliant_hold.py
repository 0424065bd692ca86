"""While one hand holds the person's arm and the other works: the holding hand gives way instead of pulling.

Usage: `yield from holding(self, hold, move_hands(self, {"right": pose}))`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...sim.world import SIDES, HandTwist
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..geometry.hold import Hold
from .arm_grip import lost_arm

_ASIDE, _DOWN = 6.0, 20.0  # pulls that are left alone: sideways or up, and down, where the arm's weight hangs [N]
_YIELDING = 0.003  # speed of giving way to more than that [m/s/N]
FASTEST = 0.03  # [m/s]


def holding(skill: Skill, hold: Hold | None, motion: Iterator[None]) -> Iterator[None]:
    """Let `motion` go on, and ease the hold on every tick.

    Raises:
        SkillFailure: ARM_SLIPPED, and whatever `motion` raises.
    """
    for _ in motion:
        ease_hold(skill, hold)
        yield


def ease_hold(skill: Skill, hold: Hold | None) -> None:
    """Give way to what the held arm pulls at the hand; a held arm is stiff, so millimetres are many newtons.

    Raises:
        SkillFailure: ARM_SLIPPED when the hand no longer holds the arm.
    """
    if hold is None:
        return
    if lost_arm(skill, hold.hand):
        raise SkillFailure(Reason.ARM_SLIPPED, f"the {hold.hand} fingers have closed")
    velocity = giving_way(skill.world.observe().wrench_hand_in_map[SIDES.index(hold.hand), :3])
    if np.any(velocity):
        skill.world.send(HandTwist(side=hold.hand, twist_in_map=np.append(velocity, np.zeros(3))), retreat=True)


def giving_way(load: np.ndarray) -> np.ndarray:
    """Velocity (3,) [m/s] with which a holding hand follows a load (3,) [N]."""
    pull = np.array(load, float)
    pull[2] = min(pull[2] + _DOWN, 0.0) if pull[2] < 0.0 else pull[2]
    size = float(np.linalg.norm(pull))
    velocity = _YIELDING * max(size - _ASIDE, 0.0) / max(size, 1e-9) * pull
    return velocity * min(1.0, FASTEST / max(float(np.linalg.norm(velocity)), 1e-9))

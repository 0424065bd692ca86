"""How far a held strap is turned from how it was taken to lie, since the sleeve below it pointed elsewhere.

What lies between the fingers is seen as a flat strip; the sleeve may hang from it turned round, as its back panel lies
folded under the front (138: by 110 degrees).  The few threads between the fingers turn the sleeve all the same: 170
degrees of the hand turned it by 130 (ideal hand, 138).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ...sim.world import SIDES, Side
from ..core.skill import Skill
from ..geometry.strap_grip import StrapGrip


@dataclass
class StrapTurns:
    """By how much each hand turns the strap that it holds, about the vertical, counter-clockwise from above [rad]."""

    angles: dict[Side, float] = field(default_factory=lambda: dict.fromkeys(SIDES, 0.0))


def strap_turns(skill: Skill) -> dict[Side, float]:
    """Hand -> by how much it turns its strap [rad]."""
    return skill.context.memory.of(StrapTurns, StrapTurns).angles


def turned_strap(skill: Skill, grip: StrapGrip) -> StrapGrip:
    """`grip` as the hand has to be turned for the sleeve, not the strip between its fingers, to hang open."""
    angle = strap_turns(skill)[grip.hand]
    x, y, z = grip.across_in_hand  # of a hand that points down: its own angles run clockwise as seen from above
    across = np.array((x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), z))
    return replace(grip, across_in_hand=across)

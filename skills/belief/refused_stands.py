"""Where the robot stood in vain: a strap that it misses, does not see or does not get to is tried from elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...sim.world import Side
from ..core.skill import Skill

# Stands from which a sleeve was missed, unseen or out of reach since it was laid there, after which it has to lie
# elsewhere: 8 cm from the hand one was out of reach five times in turn (151, 190), one was missed four times alike
# (117), and one under a fold was looked for four times, a minute each (192).
REFUSED = 2


@dataclass
class RefusedStands:
    """Base poses (3,) in the map from which a sleeve was missed or out of reach, by the person's side."""

    poses: dict[Side, list[np.ndarray]] = field(default_factory=dict)


def refused_stands(skill: Skill, side: Side) -> list[np.ndarray]:
    """The run's memory of base poses (3,) from which that side's sleeve was not taken [m, m, rad]."""
    return skill.context.memory.of(RefusedStands, RefusedStands).poses.setdefault(side, [])

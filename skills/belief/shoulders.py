"""Where the shoulders are, as a collar that sits well lies in the middle between them."""

from __future__ import annotations

import numpy as np

from ...sim.world import SIDES
from ..core.skill import Skill
from ..geometry.stances import HEADWARD
from .person_tracking import watch_arm, watch_of


def between_shoulders(skill: Skill) -> np.ndarray:
    """(3,) middle between the shoulders, where the arms were seen last: under the gown they may not show [m].

    Raises:
        PerceptionFailure: an arm was never found, and does not show.
    """
    known = watch_of(skill).arms
    arms = [known[side] if side in known else watch_arm(skill, side) for side in SIDES]
    return np.mean([arm.points_in_map[0] for arm in arms], axis=0)


def off_middle(place: np.ndarray, middle: np.ndarray) -> tuple[float, float]:
    """How far a place (3,) is aside of, and headward of, the `middle` between the shoulders (3,) [m]."""
    return float(place[0] - middle[0]), float((place - middle) @ HEADWARD)

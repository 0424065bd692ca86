"""Where the collar lies between the shoulders."""

from __future__ import annotations

import numpy as np

from ...perception.estimates import GraspPoint
from ...sim.world import SIDES
from ..core.skill import Skill
from ..geometry.stances import HEADWARD
from .person_tracking import watch_arm, watch_of


def look_at_collar(skill: Skill, middle: np.ndarray, away: tuple[float, float] = (0.0, 0.0)) -> GraspPoint:
    """Where the middle of the neckline lies, or the cloth `away` from it [m].

    Args:
        skill: that looks.
        middle: (3,) between the shoulders [m].
        away: from there to where the cloth is to be grasped, along x and y in the map [m].

    Raises:
        PerceptionFailure: too little of it is seen.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    return skill.context.senses.collar_middle(skill.world.look("head"), near_in_map=middle, away=away)


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

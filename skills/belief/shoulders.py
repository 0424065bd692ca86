"""Where the collar lies between the shoulders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.estimates import GraspPoint
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES
from ..core.skill import Skill
from ..geometry.stances import HEADWARD
from .close_look import close_look
from .person_tracking import watch_arm, watch_of


@dataclass(frozen=True, kw_only=True)
class CollarSeen(Quantities):
    """Where the middle of the neckline is seen."""

    aside: float = quantity(
        0.018,
        "m",
        "by which it is seen too far to the person's right",
        "measured: 46 states of nine development seeds in which 0.85 of it and more shows from the head of the bed and "
        "from beside both shoulders: 0.012, 0.030 and 0.011 m on average; the mean of the three is off by 0.013 m then "
        "(root mean square), at worst by 0.030 m",
    )


COLLAR_SEEN = CollarSeen()


def look_at_collar(skill: Skill, middle: np.ndarray, away: tuple[float, float] = (0.0, 0.0)) -> GraspPoint:
    """Where the middle of the neckline lies, or the cloth `away` from it [m].

    Where it was looked at closely, and nothing was taken hold of since, that tells, and the head's camera only what
    cloth there is.

    Args:
        skill: that looks.
        middle: (3,) between the shoulders [m].
        away: from there to where the cloth is to be grasped, along x and y in the map [m].

    Raises:
        PerceptionFailure: too little of it is seen.
        SensorLost: the camera is dead.
        SkillFailure: its picture is stale.
    """
    known = close_look(skill)
    if known is not None and not any(away):
        return known
    frame = skill.world.look("head")
    if known is not None:
        from_head = skill.context.senses.collar_middle(frame, near_in_map=middle, away=(0.0, 0.0))
        x, y = (known.position_in_map - from_head.position_in_map)[:2] + away
        away = float(x), float(y)
    return skill.context.senses.collar_middle(frame, near_in_map=middle, away=away)


def between_shoulders(skill: Skill) -> np.ndarray:
    """(3,) middle between the shoulders, where the arms were seen last: under the gown they may not show [m].

    Raises:
        PerceptionFailure: an arm was never found, and does not show.
    """
    known = watch_of(skill).arms
    arms = [known[side] if side in known else watch_arm(skill, side) for side in SIDES]
    return np.mean([arm.points_in_map[0] for arm in arms], axis=0)


def off_middle(collar: np.ndarray, middle: np.ndarray, seen: CollarSeen = COLLAR_SEEN) -> tuple[float, float]:
    """How far a collar seen at a place (3,) is aside of, and headward of, the `middle` between the shoulders (3,) [m].

    Args:
        collar: where its middle is seen.
        middle: between the shoulders.
        seen: how well it is seen.
    """
    return float(collar[0] - middle[0]) - seen.aside, float((collar - middle) @ HEADWARD)

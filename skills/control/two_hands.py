"""Two hands that take and carry one cloth, each its own place."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping

import numpy as np

from ...sim.world import Side
from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..motion.errors import MotionError
from .carry import Carry, carry
from .hands import gap_between_arms
from .together import together


def take_each(grasps: Mapping[Side, Callable[[], Iterator[None]]]) -> Generator[None, None, list[Side]]:
    """Grasp with one hand after the other, and say which hold: one that misses does not keep the other from it.

    Args:
        grasps: side -> the grasp of that hand.

    Raises:
        MotionError: no hand gets there.
        SkillFailure: GRASP_MISSED where neither holds any, and whatever else goes wrong.
    """
    held: list[Side] = []
    problems: list[MotionError | SkillFailure] = []
    for side, grasp in grasps.items():
        try:
            yield from grasp()
            held.append(side)
        except (MotionError, SkillFailure) as problem:
            if isinstance(problem, SkillFailure) and problem.reason != Reason.GRASP_MISSED:
                raise
            problems.append(problem)
    if not held:
        raise problems[-1]
    return held


def carry_each(
    skill: Skill, places: Mapping[Side, np.ndarray], law: Carry, apart: float, speed: float | None = None
) -> Iterator[None]:
    """All hands at once, each to its place, as long as the robot's arms stay apart.

    Args:
        skill: that carries.
        places: side -> (3,) where that hand goes in the map [m].
        law: speed and loads.
        apart: between the robot's arms, at which all stop [m].
        speed: instead of the law's [m/s].
    """
    for _ in together(*(carry(skill, side, place, law, speed) for side, place in places.items())):
        if gap_between_arms(skill) < apart:
            return
        yield

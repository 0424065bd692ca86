"""Taking cloth that lies on the person: a hand comes down from above, tilted no more than it must be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...perception.estimates import GraspPoint
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..belief.close_look import CloseLook
from ..core.skill import Skill
from ..geometry.from_above import from_above
from .pinch import grasp_poses, pinch_or_back_off, reach_in


@dataclass(frozen=True, kw_only=True)
class FromAbove(Quantities):
    """How a hand comes down to cloth on the person."""

    max_tilt: float = quantity(
        float(np.deg2rad(35.0)), "rad", "of the approach off the vertical", "choice: the hand comes from above"
    )
    opening: float = quantity(
        0.05, "m", "of the fingers on the way in", "choice: about one cell of the cloth; wider, one goes down beside it"
    )
    depth: float = quantity(0.0, "m", "of the fingertips beyond the cloth", "choice: the body is right below it")
    speed: float = quantity(
        0.10,
        "m/s",
        "of the hand to before the cloth; half of it on the way in, and less next to the person",
        "choice: slow beside the person; it does not lower the 80 N with which closing fingers met the trunk (101)",
    )


def within_reach(skill: Skill, hand: Side, point: GraspPoint, outward: np.ndarray, law: FromAbove) -> None:
    """Whether `take_from_above` gets to a point from where the robot stands; its arguments, and nothing moves.

    Raises:
        Unreachable: it does not.
    """
    approach = from_above(point.approach_in_map, outward, law.max_tilt)
    grasp_poses(skill, hand, point.position_in_map, approach, point.closing_in_map, depth=law.depth)


def take_from_above(skill: Skill, hand: Side, point: GraspPoint, outward: np.ndarray, law: FromAbove) -> Iterator[None]:
    """Take cloth at a point; where nothing is between the fingers, they open and the hand draws back.

    Args:
        skill: that takes it.
        hand: that comes down.
        point: where the cloth was seen.
        outward: (3,) unit vector from the body's middle to where the robot stands.
        law: how it comes down.

    Raises:
        MotionError: out of reach.
        SkillFailure: GRASP_MISSED, COMMAND_LOST or MOTION_BLOCKED.
    """
    CloseLook.of(skill).forget()
    approach = from_above(point.approach_in_map, outward, law.max_tilt)
    yield from reach_in(
        skill,
        hand,
        point.position_in_map,
        approach,
        point.closing_in_map,
        opening=law.opening,
        depth=law.depth,
        speed=law.speed,
    )
    yield from pinch_or_back_off(skill, hand)

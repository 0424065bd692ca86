"""Scripted estimates of a hung gown, for worlds without images: what stages A and B ask for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from ...perception.estimates import CORNER_OF, Estimate, GownSide, GraspPoint, LayerCount, PreGrasp
from ...sim.robot.kinematics import planar_pose
from ...sim.world import Frame, Observation, Side
from ..core.context import Perception

PLACE = np.array((0.70, 0.0, 1.20))  # of the gown, in base [m]
ASIDE, BELOW = 0.18, 0.37  # of a corner of its neckline from its middle, which the hook holds [m]


class Senses(Protocol):
    """What knows where the robot is."""

    def observe(self) -> Observation:
        """Latest proprioception."""
        ...


class Stage(Protocol):
    """The part of a context that scripted estimators use."""

    @property
    def world(self) -> Senses:
        """Where the robot is."""
        ...

    @property
    def perception(self) -> Perception:
        """Where the estimators go."""
        ...


def offer_gown(context: Stage) -> None:
    """Give a context without estimators the ones that stages A and B ask for."""

    def point(frame: Frame, target: Any, lateral: float, below: float = 0.0) -> GraspPoint:
        base = planar_pose(context.world.observe().pose_base_in_map)
        place = base @ np.append(PLACE + (0.0, lateral, -below), 1.0)
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.9,
            target=target,
            position_in_map=place[:3],
            approach_in_map=base[:3, 0],
            closing_in_map=base[:3, 1],
        )

    def hung(frame: Frame, side: Side, **_: Any) -> Estimate:
        return point(frame, CORNER_OF[side], ASIDE if side == "right" else -ASIDE, BELOW)

    def shown(frame: Frame, side: Side | None = None, **_: Any) -> Estimate:
        return hung(frame, side or "left")

    def hang(frame: Frame) -> Estimate:
        return point(frame, "near_hang", 0.0)

    def facing(frame: Frame) -> Estimate:
        return GownSide(stamp=frame.stamp, confidence=0.9, outside=True)

    def held(frame: Frame, **_: Any) -> Estimate:
        return Estimate(stamp=frame.stamp, confidence=0.9)

    def corner(frame: Frame, poses_hand_in_map: Sequence[np.ndarray], **_: Any) -> Estimate:
        found = point(frame, "near_hang", 0.1)
        return PreGrasp(
            stamp=frame.stamp,
            confidence=0.9,
            view=0,
            primitive="direct",
            corner_in_map=found.position_in_map,
            position_in_map=found.position_in_map,
            approach_in_map=found.approach_in_map,
            sweep_in_map=np.zeros(3),
        )

    def layers(frame: Frame, side: Side, **_: Any) -> Estimate:
        return LayerCount(stamp=frame.stamp, confidence=0.9, side=side, layers=1)

    for name, estimator in (
        ("hang_point", hang),
        ("hook", hang),
        ("hung_corner", hung),
        ("shown_corner", shown),
        ("gown_side", facing),
        ("hung_side", facing),
        ("gripped_cloth", held),
        ("pre_grasp", corner),
        ("layers", layers),
    ):
        context.perception.offer(name, estimator)

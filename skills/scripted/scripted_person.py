"""A person and a gown that are always seen at the same place: estimators for examples and tests of stages C and D."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...perception.estimates import (
    COLLAR_OF,
    SLEEVE_OF,
    ArmPosture,
    Cover,
    Estimate,
    GraspPoint,
    Head,
    SleeveHeading,
    SleeveOpening,
    WornSleeve,
)
from ...sim.world import Frame, Side
from .scripted_gown import Stage

# shoulder, elbow, wrist, fingertip of a right arm at rest [m]
LYING = np.array(((0.20, -0.55, 0.70), (0.40, -0.36, 0.67), (0.55, -0.16, 0.66), (0.65, -0.02, 0.66)))
STRAP = np.array((0.50, 0.10, 0.64))  # of the right sleeve [m]


def mirrored(points: np.ndarray, side: Side) -> np.ndarray:
    """Points (n, 3) given for the right side, on `side`."""
    return points if side == "right" else points * (-1.0, 1.0, 1.0)


def lying_posture(side: Side, stamp: float = 0.0) -> ArmPosture:
    """An arm at rest, well known."""
    return ArmPosture(
        stamp=stamp, confidence=0.9, side=side, points_in_map=mirrored(LYING, side), deviation=np.full(4, 0.01)
    )


def laid_strap(side: Side, stamp: float = 0.0) -> SleeveOpening:
    """The strap of a gown that lies on the bed."""
    ring = mirrored(STRAP + 0.08 * np.array([(np.cos(a), 1.0 + np.sin(a), 0.0) for a in np.linspace(0, 6, 24)]), side)
    return SleeveOpening(
        stamp=stamp,
        confidence=0.9,
        target=SLEEVE_OF[side],
        position_in_map=mirrored(STRAP, side),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, -1.0, 0.0)),
        ring_points_in_map=ring,
        centre_in_map=ring.mean(axis=0),
    )


def offer_person(context: Stage) -> None:
    """Give a context without estimators the ones that stages C and D ask for."""

    def arm(frame: Frame, side: Side, **_: Any) -> Estimate:
        return lying_posture(side, frame.stamp)

    def sleeve(frame: Frame, side: Side, **_: Any) -> Estimate:
        return laid_strap(side, frame.stamp)

    def head(frame: Frame) -> Estimate:
        return Head(stamp=frame.stamp, confidence=0.9, crown_in_map=np.array((0.0, -0.86, 0.72)), middle=0.0)

    def cover(frame: Frame, **_: Any) -> Estimate:
        return Cover(stamp=frame.stamp, confidence=0.9, share=1.0)

    def cloth(frame: Frame, **_: Any) -> Estimate:
        return Estimate(stamp=frame.stamp, confidence=0.9)

    def collar(frame: Frame, side: Side, **_: Any) -> Estimate:
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.9,
            target=COLLAR_OF[side],
            position_in_map=mirrored(np.array((0.14, -0.5, 0.80)), side),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    def worn(frame: Frame, side: Side, **_: Any) -> Estimate:
        return WornSleeve(stamp=frame.stamp, confidence=0.9, side=side, armhole_at=0.1, cuff_at=0.6, round_arm=0.8)

    def heading(frame: Frame, side: Side, **_: Any) -> Estimate:
        return SleeveHeading(
            stamp=frame.stamp, confidence=0.9, side=side, cuff_from_armhole_in_map=mirrored(LYING[3] - LYING[2], side)
        )

    for name, estimator in (
        ("arm", arm),
        ("sleeve_opening", sleeve),
        ("sleeve_strap", sleeve),
        ("sleeve_heading", heading),
        ("chest_cover", cover),
        ("held_armhole", sleeve),
        ("hand_cover", cover),
        ("cuff_round", cover),
        ("head", head),
        ("worn_sleeve", worn),
        ("gripped_cloth", cloth),
        ("collar_near_shoulder", collar),
    ):
        context.perception.offer(name, estimator)

"""A person at rest and a gown that lies on the bed, as scripted senses and tests see them."""

from __future__ import annotations

import numpy as np

from ...perception.estimates import SLEEVE_OF, ArmPosture, SleeveOpening
from ...sim.world import Side

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

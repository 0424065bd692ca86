"""A person at rest and a gown that lies on the bed, as scripted senses and tests see them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.estimates import SLEEVE_OF, ArmPosture, SleeveOpening
from ...sim.quantity import Quantities, quantity
from ...sim.world import Side


@dataclass(frozen=True, kw_only=True)
class ScriptedPerson(Quantities):
    """Where the right arm and the right sleeve lie, in the map; the left ones mirror them."""

    shoulder: tuple[float, float, float] = quantity(
        (0.20, -0.55, 0.70), "m", "of the right arm at rest", "choice: an adult in the middle of the bed"
    )
    elbow: tuple[float, float, float] = quantity(
        (0.40, -0.36, 0.67), "m", "of the right arm at rest", "choice: an adult in the middle of the bed"
    )
    wrist: tuple[float, float, float] = quantity(
        (0.55, -0.16, 0.66), "m", "of the right arm at rest", "choice: an adult in the middle of the bed"
    )
    fingertip: tuple[float, float, float] = quantity(
        (0.65, -0.02, 0.66), "m", "of the right arm at rest", "choice: an adult in the middle of the bed"
    )
    strap: tuple[float, float, float] = quantity(
        (0.50, 0.10, 0.64), "m", "middle of the right sleeve's strap", "choice: just beyond the fingertips"
    )
    armhole_radius: float = quantity(0.08, "m", "of the round armhole that lies flat", "choice: about an adult's")


PERSON = ScriptedPerson()


def mirrored(points: np.ndarray, side: Side) -> np.ndarray:
    """Points (n, 3) given for the right side, on `side`."""
    return points if side == "right" else points * (-1.0, 1.0, 1.0)


def lying_arm(side: Side) -> np.ndarray:
    """Shoulder, elbow, wrist and fingertip (4, 3) of an arm at rest in the map [m]."""
    return mirrored(np.array((PERSON.shoulder, PERSON.elbow, PERSON.wrist, PERSON.fingertip)), side)


def lying_posture(side: Side, stamp: float = 0.0) -> ArmPosture:
    """An arm at rest, well known."""
    return ArmPosture(stamp=stamp, confidence=0.9, side=side, points_in_map=lying_arm(side), deviation=np.full(4, 0.01))


def laid_strap(side: Side, stamp: float = 0.0) -> SleeveOpening:
    """The strap of a gown that lies on the bed, beside its armhole."""
    strap = np.array(PERSON.strap)
    circle = np.array([(np.cos(a), 1.0 + np.sin(a), 0.0) for a in np.linspace(0, 6, 24)])
    ring = mirrored(strap + PERSON.armhole_radius * circle, side)
    return SleeveOpening(
        stamp=stamp,
        confidence=0.9,
        target=SLEEVE_OF[side],
        position_in_map=mirrored(strap, side),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, -1.0, 0.0)),
        armhole_points_in_map=ring,
        centre_in_map=ring.mean(axis=0),
    )

"""How large the difficulties of a harder world are, all in one place; names and kinds in `sim/world_kind.py`.

What a difficulty changes is drawn from the seed by a random stream of its own, so that the rest of the scene stays as
it is without it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import radians

from ..quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class FallingArms(Quantities):
    """Arms of a grown person who cannot move them: they weigh what arms weigh, and their joints hardly resist."""

    body_mass: tuple[float, float] = quantity(
        (50.0, 90.0),
        "kg",
        "of the person, at least and at most; an arm is 5 % of it, 2.5 to 4.5 kg",
        "paper: Winter, Biomechanics of Human Movement, table 4.1, for the share; choice: adults on a ward",
    )
    shoulder_friction: tuple[float, float] = quantity(
        (0.4, 1.0),
        "N m",
        "of each axis of the shoulder, at least and at most",
        "choice: a tenth of the 7 to 13 N m that gravity has there; Engin and Chen 1986, J Biomech Eng 108:222, "
        "measure passive resistance only beyond the range of voluntary motion",
    )
    elbow_friction: tuple[float, float] = quantity(
        (0.2, 0.6),
        "N m",
        "of the elbow, at least and at most",
        "paper: Wiegner and Watts 1986, JNNP 49:1171: relaxed elbows resist with 0.4 to 1.8 N m/rad, here over a third "
        "of a radian; gravity has 2 to 4 N m there",
    )
    viscous: tuple[float, float] = quantity(
        (0.4, 0.8),
        "N m s/rad",
        "of every joint, at least and at most",
        "choice: a falling arm reaches 2 to 3 m/s at the wrist and does not swing back",
    )
    flexion: tuple[float, float] = quantity(
        (0.0, radians(90.0)),
        "rad",
        "of the elbow at the start, at least and at most",
        "design requirement: 0 to 90 degrees",
    )
    abduction: tuple[float, float] = quantity(
        (radians(10.0), radians(60.0)),
        "rad",
        "of the upper arm from the body at the start, at least and at most",
        "design requirement: 10 to 60 degrees",
    )
    clearance: float = quantity(
        0.02,
        "m",
        "of hand and forearm from the trunk, and of the fingertip from the edge of the bed, at the start, at least",
        "choice: arms have been laid beside the body before a gown is laid on it",
    )
    stiff_share: float = quantity(
        0.15,
        "1",
        "of shoulders that are stiff",
        "choice: now and then; after strokes it is one in four (Front Neurol 2023, 13:1041263, table 2: 59 of 239 with "
        "at most 90 degrees of abduction)",
    )
    stiff_friction: tuple[float, float] = quantity(
        (2.0, 4.0),
        "N m",
        "of each axis of a stiff shoulder, at least and at most",
        "choice: felt by whoever lifts it, and less than the arm's weight",
    )
    stiff_elevation: tuple[float, float] = quantity(
        (radians(30.0), radians(50.0)),
        "rad",
        "off the bed at which a stiff shoulder's range ends, at least and at most",
        "choice: a third to a half of 90 degrees",
    )
    stiff_abduction: tuple[float, float] = quantity(
        (radians(60.0), radians(80.0)),
        "rad",
        "from the body at which a stiff shoulder's range ends, at least and at most",
        "paper: Front Neurol 2023, 13:1041263: severe restriction ends before 90 degrees; above every start",
    )
    end_stiffness: float = quantity(
        20.0,
        "N m/rad",
        "of a stiff shoulder beyond its range",
        "choice: 10 degrees too far resist with 3.5 N m, 7 N at the wrist",
    )
    stirring: float = quantity(
        15.0, "N m", "of the shoulders of a person who stirs", "choice: above what gravity and the bed's friction hold"
    )


@dataclass(frozen=True, kw_only=True)
class Sizes(Quantities):
    """How large each difficulty is; a difficulty has the name of its field."""

    falling_arms: FallingArms = field(default_factory=FallingArms)


SIZES = Sizes()

"""Where to stand beside the bed to dress an arm, mirrored between its two sides.

Found with inverse kinematics over arms at rest of all sizes and poses in `sim.scene`: from `lift` the head-side hand
lifts the arm and the feet-side hand takes the sleeve and pulls it up to the elbow, from `shoulder` up to the neck.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Side

Stand = Literal["lift", "shoulder"]
LIFTING: dict[Side, Side] = {"right": "left", "left": "right"}  # arm -> the robot's hand on the head side
PULLING: dict[Side, Side] = {"right": "right", "left": "left"}  # arm -> the robot's hand on the feet side
HEADWARD = np.array((0.0, -1.0, 0.0))  # in the map, where the bed's head is at the lower y

_FOUND = "choice: found with inverse kinematics over arms at rest of all sizes and poses in sim.scene"


@dataclass(frozen=True, kw_only=True)
class StanceTuning(Quantities):
    """Where the base stands and slides, in the map, whose origin is the middle of the bed."""

    lift: tuple[float, float] = quantity(
        (1.05, -0.38), "m", "x and y of the base that lifts the person's right arm and takes its sleeve", _FOUND
    )
    shoulder: tuple[float, float] = quantity(
        (0.97, -0.62), "m", "x and y of the base that pulls the right sleeve from the elbow to the neck", _FOUND
    )
    head: tuple[float, float] = quantity(
        (0.0, -1.32),
        "m",
        "x and y of the base at the head of the bed, from where both hands reach both shoulders",
        "choice: inverse kinematics, hands that point down from 0.2 to 0.4 m aside, 0.45 to 0.75 m from the bed's edge",
    )
    lane: float = quantity(
        0.77,
        "m",
        "from the middle of the bed to the base that slides along it",
        "choice: the base's deck reaches under the edge of the mattress",
    )
    ahead: float = quantity(
        0.55, "m", "of the hands before the base's centre while it slides", "choice: both arms work there with ease"
    )
    heading: float = quantity(
        float(-np.pi / 2), "rad", "of the base that slides", "choice: it faces the head of the bed, as `HEADWARD` does"
    )


STANCES = StanceTuning()


def stance(arm: Side, stand: Stand, *, tuning: StanceTuning = STANCES) -> np.ndarray:
    """Base pose (3,) in the map beside one of the person's arms, facing the bed [m, m, rad]."""
    x, y = {"lift": tuning.lift, "shoulder": tuning.shoulder}[stand]
    return np.array((x, y, np.pi)) if arm == "right" else np.array((-x, y, 0.0))


def stance_at_head(*, tuning: StanceTuning = STANCES) -> np.ndarray:
    """Base pose (3,) in the map at the head of the bed, facing its foot [m, m, rad]."""
    return np.array((*tuning.head, np.pi / 2))


def outwards(arm: Side) -> np.ndarray:
    """Unit vector (3,) in the map from the body's middle to that side of the bed, where the robot stands."""
    return np.array((1.0 if arm == "right" else -1.0, 0.0, 0.0))

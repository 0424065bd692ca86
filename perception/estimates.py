"""What perception says: frozen values with a stamp and a confidence, whoever estimated them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..sim.world import Side

GraspTarget = Literal["near_hang", "collar_corner_left", "collar_corner_right", "sleeve_left", "sleeve_right",
                      "collar_left", "collar_right"]


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Base of all estimates.

    Attributes:
        stamp: world clock of the image it came from [s].
        confidence: 0 (a guess) to 1 (certain).
    """

    stamp: float
    confidence: float


@dataclass(frozen=True, kw_only=True)
class GarmentMask(Estimate):
    """Pixels of the gown.  mask: (H, W) bool."""

    mask: np.ndarray


@dataclass(frozen=True, kw_only=True)
class GraspPoint(Estimate):
    """Where to close the fingers.

    Attributes:
        target: which part of the gown it is.
        position_in_map: (3,) [m].
        approach_in_map: (3,) unit vector from the hand to the cloth.
        closing_in_map: (3,) unit vector along which the fingers close (across the cloth's edge or fold).
    """

    target: GraspTarget
    position_in_map: np.ndarray
    approach_in_map: np.ndarray
    closing_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class GownSide(Estimate):
    """Which side of the gown the camera sees: the printed outside or the plain inside."""

    outside: bool


@dataclass(frozen=True, kw_only=True)
class ArmPosture(Estimate):
    """One arm of the person as a chain of four points in the map frame, (4, 3) [m].

    Attributes:
        side: the person's own left or right.
        points_in_map: shoulder, elbow, wrist, fingertip.
        deviation: (4,) standard deviation of each point [m].
    """

    side: Side
    points_in_map: np.ndarray
    deviation: np.ndarray


@dataclass(frozen=True, kw_only=True)
class LayerCount(Estimate):
    """How many layers of cloth are between the fingers of one hand (0: missed)."""

    side: Side
    layers: int

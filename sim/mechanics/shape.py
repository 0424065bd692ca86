"""Primitives that links are made of: for contact, for distances, and to be looked at."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Shape:
    """A primitive fixed to a link.

    Attributes:
        kind: `box` or `capsule` (along the local z axis).
        size: box edges (x, y, z) [m]; capsule radius and length between the centres of its caps [m].
        xyz: centre in the link frame [m].
        rpy: orientation in the link frame, URDF convention [rad].
        rgb: colour of the visual made from it, or None when it is a collision shape only.
    """

    kind: Literal["box", "capsule"]
    size: tuple[float, ...]
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rgb: tuple[float, float, float] | None = None

    @property
    def axis(self) -> np.ndarray:
        """Unit vector (3,) of the local z axis in the link frame."""
        roll, pitch, yaw = self.rpy
        (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle), math.sin(angle)) for angle in (roll, pitch, yaw))
        return np.array((cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr))


@dataclass(frozen=True, kw_only=True)
class LinkCapsule:
    """A capsule fixed to a link.

    Attributes:
        name: `left_palm_1`, `right_finger_2`, `left_forearm`, `torso_1`, ...
        link: that carries it.
        ends: (2, 3) of its axis, in the link's frame [m].
        radius: [m].
    """

    name: str
    link: str
    ends: np.ndarray
    radius: float

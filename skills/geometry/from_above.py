"""How a hand comes to cloth that lies on the person: from above, and from the robot's side of the bed."""

from __future__ import annotations

import math

import numpy as np

from ...perception.image.cloud import unit
from .arm_path import UP


def from_above(approach: np.ndarray, outward: np.ndarray, max_tilt: float) -> np.ndarray:
    """The approach nearest to one square to the cloth that comes from above and from the robot's side of the bed.

    Args:
        approach: (3,) unit vector, square to the cloth.
        outward: (3,) unit vector from the body's middle to the robot's side.
        max_tilt: of the approach off the vertical [rad].
    """
    lean = approach + UP * max(-float(approach @ UP), 0.0)  # the horizontal part
    if lean @ outward > 0.0:
        lean = lean - (lean @ outward) * outward
    angle = min(float(math.atan2(np.linalg.norm(lean), max(-float(approach[2]), 1e-6))), max_tilt)
    return -math.cos(angle) * UP + math.sin(angle) * (unit(lean) if np.linalg.norm(lean) > 1e-6 else np.zeros(3))

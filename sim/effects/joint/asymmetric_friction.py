"""Dry friction whose size differs between the two directions."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape
from .coulomb_friction import WIDTH


class AsymmetricFriction(JointEffect):
    """Load `forward` when moving forward and `-backward` when moving backward, the change taking the speed `width`."""

    name = "asymmetric_friction"
    linear = (Parameter(name="forward", unit="F", lower=0.0), Parameter(name="backward", unit="F", lower=0.0))
    optional = (WIDTH,)
    sharp = True
    contains = frozenset({"coulomb_friction"})
    sentence = "dry friction that differs between forward and backward motion"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Forward and backward indicators, (T, 2)."""
        direction = motion.direction_within(shape.get("width", 0.0))
        return np.stack([np.maximum(direction, 0.0), np.minimum(direction, 0.0)], axis=1)

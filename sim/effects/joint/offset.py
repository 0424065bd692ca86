"""A constant in the measured load: a sensor's zero, a counterweight, a cable."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class Offset(JointEffect):
    """Load `value`."""

    name = "offset"
    linear = (Parameter(name="value", unit="F"),)
    sentence = "a constant offset of the measured load"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Ones, (T, 1)."""
        return np.ones((len(motion.t), 1))

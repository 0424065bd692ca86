"""Friction in proportion to speed: oil in a gearbox, damping of a bearing."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class ViscousFriction(JointEffect):
    """Load `coefficient * dq`."""

    name = "viscous_friction"
    linear = (Parameter(name="coefficient", unit="F s/x", lower=0.0),)
    sentence = "friction in proportion to speed"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Velocity, (T, 1)."""
        return motion.dq[:, None]

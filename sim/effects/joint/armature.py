"""Inertia of the motor's rotor seen through the gear, which link-only models leave out."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class Armature(JointEffect):
    """Load `inertia * ddq`."""

    name = "armature"
    linear = (Parameter(name="inertia", unit="F s^2/x", lower=0.0),)
    sentence = "rotor inertia seen through the gear"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Acceleration, (T, 1)."""
        return motion.ddq[:, None]

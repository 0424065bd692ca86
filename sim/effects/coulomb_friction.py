"""Dry friction: constant in size, against the motion."""

from __future__ import annotations

import numpy as np

from .effect import JointEffect, JointMotion, Parameter, Shape


class CoulombFriction(JointEffect):
    """Load `level * sign(dq)`."""

    name = "coulomb_friction"
    linear = (Parameter(name="level", unit="F", lower=0.0),)
    sentence = "dry friction of constant size"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Direction of motion, (T, 1)."""
        return motion.direction[:, None]

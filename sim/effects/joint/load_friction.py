"""Dry friction that grows with the load carried: gear meshes, screws, brakes."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class LoadFriction(JointEffect):
    """Load `ratio * |load_model| * sign(dq)`."""

    name = "load_friction"
    linear = (Parameter(name="ratio", unit="1", lower=0.0, upper=10.0),)
    sharp = True
    sentence = "friction that grows with the load carried"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Size of the rigid load in the direction of motion, (T, 1)."""
        return (np.abs(motion.load) * motion.direction)[:, None]

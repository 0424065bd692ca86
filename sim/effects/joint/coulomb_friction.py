"""Dry friction: constant in size, against the motion."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape

WIDTH = Parameter(name="width", unit="x/s", lower=0.0)


class CoulombFriction(JointEffect):
    """Load `level * sign(dq)`, the sign passing through zero within the speed `width`.

    Gears and seals do not jump from one friction to the other: they wind up and creep first.
    """

    name = "coulomb_friction"
    linear = (Parameter(name="level", unit="F", lower=0.0),)
    optional = (WIDTH,)
    sharp = True
    sentence = "dry friction of constant size"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Direction of motion, (T, 1)."""
        return motion.direction_within(shape.get("width", 0.0))[:, None]

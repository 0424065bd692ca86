"""Dry friction that is larger near standstill and falls with speed (Stribeck curve)."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape, Spread


class StribeckFriction(JointEffect):
    """Load `(level + excess * exp(-(dq / speed)^2)) * sign(dq)`; level 0 leaves the low-speed part alone."""

    name = "stribeck_friction"
    linear = (Parameter(name="level", unit="F", lower=0.0), Parameter(name="excess", unit="F", lower=0.0))
    shape = (Parameter(name="speed", unit="x/s", lower=0.0),)
    contains = frozenset({"coulomb_friction"})
    sharp = True
    sentence = "dry friction with extra grip near standstill"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Direction, and direction faded out above the Stribeck speed, (T, 2)."""
        direction = motion.direction
        fade = np.exp(-((motion.dq / max(shape["speed"], 1e-9)) ** 2))
        return np.stack([direction, direction * fade], axis=1)

    def shapes(self, spread: Spread) -> list[Shape]:
        """Five speeds from 3 % to 60 % of the usual speed, none below what the log resolves."""
        floor = 2.0 * spread.slow
        return [{"speed": v} for v in spread.speed * np.array([0.03, 0.07, 0.15, 0.3, 0.6]) if v > floor]

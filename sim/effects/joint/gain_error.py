"""A load sensor or motor constant whose scale is wrong."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class GainError(JointEffect):
    """Load `fraction * load_model`: the reading is (1 + fraction) times the load."""

    name = "gain_error"
    linear = (Parameter(name="fraction", unit="1", lower=-0.95, upper=20.0),)
    sentence = "a wrong scale of the measured load"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """The rigid load itself, (T, 1)."""
        return motion.load[:, None]

"""An elastic pull towards a rest position: a cable bundle, a counterbalance, a soft stop."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class Spring(JointEffect):
    """Load `stiffness * q - preload`; the rest position is preload / stiffness."""

    name = "spring"
    linear = (Parameter(name="stiffness", unit="F/x", lower=0.0), Parameter(name="preload", unit="F"))
    contains = frozenset({"offset"})
    sentence = "an elastic pull towards a rest position"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Position and a constant, (T, 2)."""
        return np.stack([motion.q, -np.ones_like(motion.q)], axis=1)

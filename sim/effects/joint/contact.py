"""Contact with something that yields elastically beyond a threshold: a wall, an end stop, a bed."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape, Spread


class Contact(JointEffect):
    """Load `side * stiffness * depth`, depth being how far the joint is beyond `threshold` on `side` (+1 or -1)."""

    name = "contact"
    linear = (Parameter(name="stiffness", unit="F/x", lower=0.0),)
    shape = (Parameter(name="threshold", unit="x"), Parameter(name="side", unit="1", lower=-1.0, upper=1.0))
    sharp = True
    sentence = "contact beyond a position"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Depth beyond the threshold, signed, (T, 1)."""
        side = shape["side"]
        return (side * np.maximum(side * (motion.q - shape["threshold"]), 0.0))[:, None]

    def shapes(self, spread: Spread) -> list[Shape]:
        """Thresholds that leave the outer 4 % to 50 % of the range in contact, on both sides."""
        low, high = spread.q
        part = np.array([0.04, 0.08, 0.14, 0.22, 0.32, 0.42, 0.5]) * (high - low)
        return [{"threshold": high - d, "side": 1.0} for d in part] + [
            {"threshold": low + d, "side": -1.0} for d in part
        ]

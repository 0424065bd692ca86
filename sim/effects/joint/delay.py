"""The recorded load lags (or leads) the recorded motion."""

from __future__ import annotations

import numpy as np

from ..effect import JointEffect, JointMotion, Parameter, Shape


class Delay(JointEffect):
    """Load `-time * d(load)/dt`, first order in the lag; positive when the load is recorded late."""

    name = "delay"
    linear = (Parameter(name="time", unit="s", lower=-0.5, upper=0.5),)
    memoryless = False
    sentence = "the load is recorded later or earlier than the motion"

    def columns(self, motion: JointMotion, shape: Shape) -> np.ndarray:
        """Minus the rate of the measured load, (T, 1)."""
        return -np.gradient(motion.measured, motion.t)[:, None]

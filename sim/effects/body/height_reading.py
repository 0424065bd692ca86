"""Sensor effects on a recorded height: scale, zero, clock."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .body_effect import BodyEffect


class _Reading(BodyEffect):
    per_mass = False
    of_air = False

    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """None: only the reading changes."""
        return np.zeros_like(np.asarray(velocity, dtype=float))


class HeightGain(_Reading):
    """Recorded height is `(1 + fraction)` times the height."""

    name = "gain_error"
    parameters = (Parameter(name="fraction", unit="1", lower=-0.9, upper=5.0),)
    sentence = "a wrong scale of the recorded height"

    def read(self, height: float, values: dict[str, float]) -> float:
        """Scaled height [m]."""
        return (1.0 + values["fraction"]) * height


class HeightOffset(_Reading):
    """Recorded height is `value` above the height."""

    name = "offset"
    parameters = (Parameter(name="value", unit="m"),)
    sentence = "a constant offset of the recorded height"

    def read(self, height: float, values: dict[str, float]) -> float:
        """Shifted height [m]."""
        return height + values["value"]


class HeightDelay(_Reading):
    """The recorded clock runs `time` behind the release."""

    name = "delay"
    parameters = (Parameter(name="time", unit="s", lower=-1.0, upper=1.0),)
    sentence = "the height is recorded later than it happens"

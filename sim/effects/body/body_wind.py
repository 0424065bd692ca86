"""Vertical wind: quadratic drag relative to air that itself rises or sinks."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .body_effect import BodyEffect


class BodyWind(BodyEffect):
    """Specific force `-coefficient * |v - w| (v - w)` with w upward at `speed`."""

    name = "wind"
    parameters = (
        Parameter(name="coefficient", unit="1/m", lower=0.0, upper=20.0),
        Parameter(name="speed", unit="m/s", lower=-30.0, upper=30.0),
    )
    contains = frozenset({"quadratic_drag"})
    usual_unit = "N s^2/m^2"
    sentence = "drag in air that rises or sinks"

    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """Against the velocity relative to the air, (..., 3) [m/s^2]."""
        relative = np.array(velocity, dtype=float)
        relative[..., 2] -= values["speed"]
        return -values["coefficient"] * np.linalg.norm(relative, axis=-1, keepdims=True) * relative

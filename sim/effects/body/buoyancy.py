"""Lift by the displaced air: a light or large body weighs less."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .body_effect import BodyEffect

AIR_DENSITY = 1.204  # [kg/m^3] at 20 C and 1013 hPa (ISO 2533 scaled)


class Buoyancy(BodyEffect):
    """Specific force `fraction * g` upward; fraction = rho_air V / m."""

    name = "buoyancy"
    parameters = (Parameter(name="fraction", unit="1", lower=0.0, upper=0.95),)
    per_mass = False
    sentence = "lift by the displaced air"

    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """Upward, (..., 3) [m/s^2]."""
        up = np.zeros_like(np.asarray(velocity, dtype=float))
        up[..., 2] = values["fraction"] * gravity
        return up

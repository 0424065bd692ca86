"""Air drag in proportion to speed squared (bluff bodies in air)."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .body_effect import BodyEffect


class QuadraticDrag(BodyEffect):
    """Specific force `-coefficient * |v| v`; coefficient = rho C_d A / (2 m)."""

    name = "quadratic_drag"
    parameters = (Parameter(name="coefficient", unit="1/m", lower=0.0, upper=20.0),)
    usual_unit = "N s^2/m^2"
    sentence = "air drag in proportion to speed squared"

    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """Against the velocity, (..., 3) [m/s^2]."""
        return -values["coefficient"] * np.linalg.norm(velocity, axis=-1, keepdims=True) * velocity

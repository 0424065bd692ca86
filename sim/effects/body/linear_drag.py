"""Air drag in proportion to speed (slow, small or porous bodies)."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .body_effect import BodyEffect


class LinearDrag(BodyEffect):
    """Specific force `-rate * v`."""

    name = "linear_drag"
    parameters = (Parameter(name="rate", unit="1/s", lower=0.0, upper=50.0),)
    usual_unit = "N s/m"
    sentence = "air drag in proportion to speed"

    def specific_force(self, velocity: np.ndarray, values: dict[str, float], gravity: float) -> np.ndarray:
        """Against the velocity, (..., 3) [m/s^2]."""
        return -values["rate"] * velocity

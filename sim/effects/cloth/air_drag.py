"""Drag of still air on moving cloth."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ProxyState


class AirDrag(ClothEffect):
    """Force `-coefficient * area * |v| v`; coefficient = air density * drag coefficient / 2."""

    name = "air_drag"
    parameters = (Parameter(name="coefficient", unit="N s^2/m^4", lower=0.0, upper=50.0),)
    needs_proxies = True
    sentence = "drag of the air on moving cloth"

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """Against the velocity, (N, 3) [N]."""
        speed = np.linalg.norm(state.v, axis=1, keepdims=True)
        return -values["coefficient"] * state.area[:, None] * speed * state.v

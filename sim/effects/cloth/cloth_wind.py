"""A steady draught of air across the cloth."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ProxyState

DRAG = 0.7  # [N s^2/m^4] air density times a drag coefficient near 1.2, halved


class ClothWind(ClothEffect):
    """Force `0.7 * area * |w - v| (w - v)` with w the wind."""

    name = "wind"
    parameters = (
        Parameter(name="x", unit="m/s", lower=-20.0, upper=20.0),
        Parameter(name="y", unit="m/s", lower=-20.0, upper=20.0),
    )
    needs_proxies = True
    sentence = "a draught of air across the cloth"

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """Along the wind relative to the cloth, (N, 3) [N]."""
        relative = np.array([values["x"], values["y"], 0.0]) - state.v
        return DRAG * state.area[:, None] * np.linalg.norm(relative, axis=1, keepdims=True) * relative

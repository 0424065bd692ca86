"""Cloth that grows stiffer when stretched, as knits do once their loops are straight."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ProxyState


class StrainStiffening(ClothEffect):
    """A spring between neighbouring proxy bodies that pulls once (1 + onset) times as long as at the start."""

    name = "strain_stiffening"
    parameters = (
        Parameter(name="stiffness", unit="N/m", lower=0.0, upper=2000.0),
        Parameter(name="onset", unit="1", lower=0.0, upper=2.0),
    )
    needs_proxies = True
    sentence = "cloth that grows stiffer when stretched"

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """Pull between neighbours that are too far apart, (N, 3) [N]."""
        i, j = state.pairs.T
        apart = state.x[j] - state.x[i]
        distance = np.linalg.norm(apart, axis=1) + 1e-12
        excess = np.maximum(distance - (1.0 + values["onset"]) * state.lengths, 0.0)
        pull = (values["stiffness"] * excess / distance)[:, None] * apart
        out = np.zeros_like(state.x)
        np.add.at(out, i, pull)
        np.add.at(out, j, -pull)
        return out

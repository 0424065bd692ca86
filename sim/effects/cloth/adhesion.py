"""Cloth that clings to the body: damp skin, static charge."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ProxyState

REACH = 0.03  # [m] from the surface within which cloth clings


def surface(x: np.ndarray, capsules: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the nearest capsule's surface (N,) and the direction towards its axis (N, 3)."""
    best = np.full(len(x), np.inf)
    towards = np.zeros_like(x)
    for a, b, radius in ((c[:3], c[3:6], c[6]) for c in capsules):
        along = np.clip(((x - a) @ (b - a)) / max(float((b - a) @ (b - a)), 1e-12), 0.0, 1.0)
        inward = a + along[:, None] * (b - a) - x
        length = np.linalg.norm(inward, axis=1) + 1e-12
        nearer = length - radius < best
        best = np.where(nearer, length - radius, best)
        towards[nearer] = (inward / length[:, None])[nearer]
    return best, towards


class Adhesion(ClothEffect):
    """A pull of `pressure` towards the nearest capsule within 3 cm of its surface."""

    name = "adhesion"
    parameters = (Parameter(name="pressure", unit="N/m^2", lower=0.0, upper=500.0),)
    needs_proxies = True
    sentence = "cloth that clings to the body"

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """Towards the body, (N, 3) [N]."""
        if not len(state.capsules):
            return np.zeros_like(state.x)
        away, towards = surface(state.x, state.capsules)
        near = np.clip(1.0 - np.maximum(away, 0.0) / REACH, 0.0, 1.0)
        return (values["pressure"] * state.area * near)[:, None] * towards

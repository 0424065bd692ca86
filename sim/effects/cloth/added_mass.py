"""Something heavy on part of the cloth: a wet patch, a seam, a name tag."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect


class AddedMass(ClothEffect):
    """Weight and inertia of `mass` spread over the proxy bodies within `radius` of a place in the start pose.

    The inertia acts through the proxy bodies' acceleration, which the caller adds to their mass where it can; the
    weight alone is a force.
    """

    name = "added_mass"
    parameters = (
        Parameter(name="mass", unit="kg", lower=0.0, upper=5.0),
        Parameter(name="x", unit="m"),
        Parameter(name="y", unit="m"),
        Parameter(name="z", unit="m"),
        Parameter(name="radius", unit="m", lower=0.0),
    )
    needs_proxies = True
    sentence = "something heavy on part of the cloth"

    def share(self, start: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """Mass each proxy body takes, (N,) [kg]; the nearest one takes all where none is within the radius."""
        away = np.linalg.norm(start - np.array([values["x"], values["y"], values["z"]]), axis=1)
        inside = away <= max(values["radius"], float(away.min()) + 1e-9)
        return values["mass"] * inside / inside.sum()

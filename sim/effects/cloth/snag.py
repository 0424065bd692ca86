"""A place of the cloth that catches on something for a while."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect, ProxyState

SETTLING = 0.1  # [s] damping over stiffness, so that the caught place does not ring
MOST_DAMPING = 0.3  # [N s/m]; more would be unstable on a proxy body


class Snag(ClothEffect):
    """The proxy body nearest to a place in the start pose is held where it is from `t0` to `t1` by a spring, damped."""

    name = "snag"
    parameters = (
        Parameter(name="stiffness", unit="N/m", lower=0.0, upper=500.0),
        Parameter(name="x", unit="m"),
        Parameter(name="y", unit="m"),
        Parameter(name="z", unit="m"),
        Parameter(name="t0", unit="s", lower=0.0),
        Parameter(name="t1", unit="s", lower=0.0),
    )
    needs_proxies = True
    sentence = "a place that catches on something for a while"

    def __init__(self) -> None:
        self._held: dict[int, np.ndarray] = {}

    def restart(self) -> None:
        """Forget where anything was caught (a new run begins)."""
        self._held.clear()

    def forces(self, state: ProxyState, values: dict[str, float]) -> np.ndarray:
        """The pull of the snag, (N, 3) [N]."""
        out = np.zeros_like(state.x)
        place = np.array([values["x"], values["y"], values["z"]])
        k = int(np.argmin(np.linalg.norm(state.start - place, axis=1)))
        if not values["t0"] <= state.t <= values["t1"]:
            self._held.pop(k, None)
            return out
        held = self._held.setdefault(k, state.x[k].copy())
        stiffness = values["stiffness"]
        out[k] = stiffness * (held - state.x[k]) - min(SETTLING * stiffness, MOST_DAMPING) * state.v[k]
        return out

"""The drop itself: how far a body has fallen after release from rest, with any set of effects."""

from __future__ import annotations

import numpy as np

GRAVITY = 9.81
STEP = 0.01  # [s]; the integrator's error is below a micrometre for any drag a log could show


def fallen(duration: float, linear: float, quadratic: float, wind: float, gravity: float) -> np.ndarray:
    """Distance fallen and speed since release from rest.

    Args:
        duration: how long [s].
        linear: drag rate [1/s].
        quadratic: drag coefficient [1/m].
        wind: upward speed of the air [m/s].
        gravity: effective gravity [m/s^2].

    Returns:
        (N, 3) time [s], distance [m], downward speed [m/s], every `STEP`.
    """
    n = int(np.ceil(duration / STEP)) + 2
    out = np.empty((n, 3))
    x = v = 0.0
    h = STEP

    def pull(u: float) -> float:
        r = u + wind
        return gravity - linear * u - quadratic * abs(r) * r

    for i in range(n):
        out[i] = i * h, x, v
        a1 = pull(v)
        a2 = pull(v + 0.5 * h * a1)
        a3 = pull(v + 0.5 * h * a2)
        a4 = pull(v + h * a3)
        x += h * (v + h * (a1 + a2 + a3) / 6.0)
        v += h * (a1 + 2 * a2 + 2 * a3 + a4) / 6.0
    return out


def height(t: np.ndarray, table: np.ndarray, release_height: float, release_t: float) -> tuple[np.ndarray, np.ndarray]:
    """Height and downward speed at times `t`, at rest before the release, (T,) each."""
    since = np.maximum(t - release_t, 0.0)
    # cubic-exact between steps: distance + speed * rest + acceleration/2 * rest^2
    i = np.minimum((since / STEP).astype(int), len(table) - 2)
    rest = since - table[i, 0]
    acceleration = (table[i + 1, 2] - table[i, 2]) / STEP
    return (
        release_height - (table[i, 1] + table[i, 2] * rest + 0.5 * acceleration * rest**2),
        table[i, 2] + acceleration * rest,
    )

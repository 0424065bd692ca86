"""The drop itself: how far a body has fallen after release from rest, with any set of effects."""

from __future__ import annotations

import numpy as np

GRAVITY = 9.81
STEP = 0.01  # [s] between rows; a constant acceleration in between errs by less than a micrometre


def fallen(duration: float, linear: float, quadratic: float, wind: float, gravity: float) -> np.ndarray:
    """Distance fallen and speed since release from rest, in closed form.

    The speed obeys dv/dt = a + b v - c v^2 with constant numbers as long as the body does not overtake the air, and
    with other constant numbers afterwards, which happens at most once.

    Args:
        duration: how long [s].
        linear: drag rate [1/s].
        quadratic: drag coefficient [1/m].
        wind: upward speed of the air [m/s].
        gravity: effective gravity [m/s^2].

    Returns:
        (N, 3) time [s], distance [m], downward speed [m/s], every `STEP`.
    """
    t = np.arange(int(np.ceil(duration / STEP)) + 2) * STEP
    out = np.empty((len(t), 3))
    out[:, 0] = t
    c = quadratic
    if wind >= 0.0 or c == 0.0:
        out[:, 1], out[:, 2] = _riccati(t, gravity - c * wind**2, -linear - 2.0 * c * wind, c)
        return out
    # the air sinks faster than the body at first and pushes it
    a, b = gravity + c * wind**2, -linear + 2.0 * c * wind
    out[:, 1], out[:, 2] = _riccati(t, a, b, -c)
    if gravity + linear * wind <= 0.0:
        return out  # it never overtakes the air
    root = complex(_root(a, b, -c))
    overtakes = float((2.0 / root * np.arctanh(-wind * root / (2.0 * a - wind * b))).real)
    later = t > overtakes
    x0 = float(_riccati(np.array([overtakes]), a, b, -c)[0][0])
    x, v = _riccati(t[later] - overtakes, gravity + linear * wind, -linear, c)
    out[later, 1], out[later, 2] = x0 - wind * (t[later] - overtakes) + x, v - wind
    return out


def _riccati(t: np.ndarray, a: float, b: float, c: float) -> tuple[np.ndarray, np.ndarray]:
    """Way and speed (T,) each of dv/dt = a + b v - c v^2 from rest, b <= 0."""
    if abs(c) < 1e-10:
        if abs(b) < 1e-4:  # the closed form would lose its digits
            return a * t**2 * (0.5 + b * t / 6.0 + (b * t) ** 2 / 24.0), a * t * (1.0 + b * t / 2.0 + (b * t) ** 2 / 6)
        return a * (np.expm1(b * t) - b * t) / b**2, a * np.expm1(b * t) / b
    root = _root(a, b, c)
    tanh = np.tanh(0.5 * root * t)
    v = 2.0 * a * tanh / (root - b * tanh)
    # log of e^(bt/2) (cosh(rt/2) - b/r sinh(rt/2)), written so that nothing overflows or cancels
    rate = 4.0 * a * c / (root - b)  # root + b
    inside = 0.5 * rate / root * np.expm1(-root * t)
    if (
        np.isrealobj(inside) and (inside <= -1.0).any()
    ):  # a drag of the wrong sign, as controls have, speeds it up for ever
        inside = inside + 0j
    return ((0.5 * rate * t + np.log1p(inside)) / c).real, v.real


def _root(a: float, b: float, c: float) -> float | complex:
    """Square root of the discriminant, imaginary where the air pushes, kept off zero."""
    inside = b * b + 4.0 * a * c
    root = float(np.sqrt(inside)) if inside >= 0.0 else 1j * float(np.sqrt(-inside))
    return root if abs(root) > 1e-7 else 1e-7


def height(
    t: np.ndarray, table: np.ndarray, release_height: float | np.ndarray, release_t: float | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Height and downward speed at times `t`, at rest before the release, (T,) each."""
    since = np.maximum(t - release_t, 0.0)
    # cubic-exact between steps: distance + speed * rest + acceleration/2 * rest^2
    i = np.minimum((since / STEP).astype(int), len(table) - 2)
    at, way, speed = table[i].T
    rest = since - at
    change = (table[i + 1, 2] - speed) / STEP * rest
    return release_height - (way + (speed + 0.5 * change) * rest), speed + change

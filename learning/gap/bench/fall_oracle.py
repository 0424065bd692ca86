"""How far apart, in standard deviations, a drop's hidden effects are from the nearest other explanation.

The ideal observer knows the noise exactly.  It fits every other set of up to two effects to the noise-free drops under
the truth; what no other set can take up, in units of the noise, bounds what any method can name.  A likelihood test
between the two is right with probability Phi(apart / 2).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np
from scipy.optimize import least_squares

FREE = {
    "linear_drag": (("linear_drag", 0.1, 0.0, 5.0),),
    "quadratic_drag": (("quadratic_drag", 0.01, 0.0, 1.0),),
    "buoyancy": (("buoyancy", 0.02, 0.0, 0.95),),
    "wind": (("wind", 0.01, 0.0, 1.0), ("updraft", 1.0, -15.0, 15.0)),
    "gain_error": (("gain_error", 0.02, -0.9, 5.0),),
    "delay": (("delay", 0.02, -0.5, 0.5),),
}
CONTAINS = {"wind": "quadratic_drag"}  # the richer one always fits as well
MOST = 4
SCALE = {"gain_error": "buoyancy"}  # and so does a free scale where the lift is known


def precision(n: int, dt: float, rms: float, memory: float, slow: float) -> np.ndarray:
    """Whitening matrix (n, n) of noise that is part exponentially remembered, part white.

    Args:
        n: samples.
        dt: between them [s].
        rms: of the noise [m].
        memory: of the slow part [s].
        slow: its share of the variance.
    """
    k = np.arange(n)
    covariance = slow * np.exp(-dt * np.abs(k[:, None] - k) / memory) + (1.0 - slow) * np.eye(n)
    return np.linalg.inv(np.linalg.cholesky(covariance)) / rms


def apart(
    hidden: Sequence[str],
    drops: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]],
    path: Callable[[dict[str, float]], tuple[np.ndarray, np.ndarray]],
    known_lift: float | None,
) -> float:
    """Distance of the truth from the nearest other set that is no richer [standard deviations].

    Args:
        hidden: effects of the truth; where one is outside the registry, every set of up to two is its rival.
        drops: time [s], height without noise [m] and whitening matrix of each fitted drop.
        path: values -> time since release [s] and height above the release [m].
        known_lift: buoyancy a stated size and mass imply, or None.
    """
    most = _count(hidden, known_lift)  # a rival with more numbers loses to its own price, not to the data
    if not set(hidden) <= set(FREE):
        most = MOST  # what no set of the registry contains is noticed only where none of them can follow it
    best = np.inf
    singles = [(n,) for n in FREE]
    for rival in [(), *singles, *combinations(FREE, 2)]:
        same = set(rival) == set(hidden) or _contains(rival, hidden, bool(known_lift))
        if same or _count(rival, known_lift) > most:
            continue
        best = min(best, _distance(rival, drops, path, known_lift))
    return float(np.sqrt(best))


def _contains(rival: Sequence[str], hidden: Sequence[str], lift_known: bool) -> bool:
    """Whether a rival can take the truth's values exactly."""
    richer = CONTAINS | (SCALE if lift_known else {})
    inside = set(rival) | {richer[n] for n in rival if n in richer}
    return set(hidden) <= inside


def _count(names: Sequence[str], known_lift: float | None) -> int:
    """Numbers a set brings; a known lift brings none."""
    return sum(len(FREE.get(n, ())) for n in names if n != "buoyancy" or not known_lift)


def _distance(
    names: Sequence[str],
    drops: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]],
    path: Callable[[dict[str, float]], tuple[np.ndarray, np.ndarray]],
    known_lift: float | None,
) -> float:
    free = [f for n in names for f in FREE[n] if not (f[0] == "buoyancy" and known_lift)]
    fixed = {"buoyancy": known_lift} if known_lift and "buoyancy" in names else {}

    def residual(x: np.ndarray) -> np.ndarray:
        values = {**fixed, **{f[0]: v for f, v in zip(free, x, strict=True)}}
        s, z = path(values)
        out = []
        for t, h, white in drops:
            model = (1.0 + values.get("gain_error", 0.0)) * np.interp(t - values.get("delay", 0.0), s, z)
            # the release height is free: projected out
            a, b = white @ (h - model), white @ np.ones(len(t))
            out.append(a - b * (a @ b) / (b @ b))
        return np.concatenate(out)

    if not free:
        return float(np.sum(residual(np.zeros(0)) ** 2))
    starts = [np.array([f[1] for f in free])]
    if "wind" in names:
        starts.append(np.array([-f[1] if f[0] == "updraft" else f[1] for f in free]))
    return min(
        2.0
        * least_squares(
            residual, s, bounds=([f[2] for f in free], [f[3] for f in free]), x_scale=[f[1] for f in free], max_nfev=40
        ).cost
        for s in starts
    )

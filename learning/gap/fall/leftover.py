"""Whether what the effects leave repeats from drop to drop: then something the bank cannot name is missing."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline
from scipy.stats import t as student

from .fit import DropFit

KNOTS = 9


def repeating(fit: DropFit, times: list[np.ndarray]) -> tuple[float, float, float]:
    """Predict each drop's leftover from the others by a smooth function of the time since release.

    Returns:
        (mean square removed out of sample [m^2], p-value over drops and stretches, time of the largest value [s]).
    """
    if len(times) < 2:
        return 0.0, 1.0, 0.0  # one drop cannot tell a repeating error from slow noise
    since = [t - r for t, r in zip(times, fit.releases[:, 1], strict=True)]
    end = max(float(s[-1]) for s in since)
    inner = np.linspace(0.0, end, KNOTS)
    knots = np.concatenate([[0.0] * 3, inner, [end] * 3])
    size = len(knots) - 4
    X = [BSpline.design_matrix(np.clip(s, 0.0, end), knots, 3, extrapolate=True).toarray() for s in since]
    gains = []
    for i, r in enumerate(fit.residuals):
        A = sum(X[j].T @ X[j] for j in range(len(X)) if j != i) + 0.1 * np.eye(size)
        b = sum(X[j].T @ fit.residuals[j] for j in range(len(X)) if j != i)
        gain = r**2 - (r - X[i] @ np.linalg.solve(A, b)) ** 2
        gains += [float(part.mean()) for part in np.array_split(gain, 4)]
    blocks = np.array(gains)
    spread = blocks.std(ddof=1) / np.sqrt(len(blocks)) + 1e-30
    A = sum(x.T @ x for x in X) + 0.1 * np.eye(size)
    shape = np.linalg.solve(A, sum(x.T @ r for x, r in zip(X, fit.residuals, strict=True)))
    grid = np.linspace(0.0, end, 200)
    curve = BSpline(knots, shape, 3)(grid)
    return float(blocks.mean()), float(student.sf(blocks.mean() / spread, len(blocks) - 1)), float(grid[np.argmax(np.abs(curve))])

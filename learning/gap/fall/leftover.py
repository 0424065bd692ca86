"""Whether a force that repeats from drop to drop is left over: then something the bank cannot name is missing."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import minimize
from scipy.signal import lfilter
from scipy.stats import f as fisher

from .fit import DropFit

PIECES = 10  # of the acceleration over the time since release
STARTS = ((0.5, -0.3), (1.4, -0.7))  # of the noise's two numbers, before tanh


def repeating(fit: DropFit, times: list[np.ndarray]) -> tuple[float, float, float]:
    """Add a free acceleration over the time since release, the same in all drops, and see whether it pays.

    The noise of what remains is taken as first-order coloured plus white and filtered out before the two fits are
    compared, so that slow noise is not mistaken for a force.

    Args:
        fit: the best set of effects.
        times: sample times of each drop [s].

    Returns:
        (mean square it removes [m^2], p-value, time since release at which it is largest [s]).
    """
    if len(times) < 2:
        return 0.0, 1.0, 0.0  # one drop cannot tell a repeating force from slow noise
    since = [np.maximum(t - r, 0.0) for t, r in zip(times, fit.releases[:, 1], strict=True)]
    end = max(float(s[-1]) for s in since)
    knots = np.concatenate([[0.0] * 3, np.linspace(0.0, end, PIECES - 2), [end] * 3])
    pieces = [BSpline.basis_element(knots[i : i + 5], extrapolate=False) for i in range(PIECES)]
    grid = np.linspace(0.0, end, 600)
    step = grid[1]
    bumps = np.stack([np.nan_to_num(b(grid)) for b in pieces], axis=1)
    fallen = np.cumsum(np.cumsum(bumps, axis=0) * step, axis=0) * step
    B = np.concatenate([np.stack([np.interp(s, grid, f) for f in fallen.T], axis=1) for s in since])
    r = np.concatenate(fit.residuals)
    own = fit.jacobian / (np.linalg.norm(fit.jacobian, axis=0) + 1e-12)  # what effects and releases could still take up
    both = np.column_stack([own, B / (np.linalg.norm(B, axis=0) + 1e-12)])
    ends = np.cumsum([len(t) for t in times])[:-1]
    theta = _solve(both, r)
    already = r - own @ _solve(own, r)
    white_r, white_own, white_both = r, own, both
    for _ in range(2):
        noise = _colour(np.split(r - both @ theta, ends))
        white_r, white_own, white_both = (_whiten(x, ends, noise) for x in (r, own, both))
        theta = _solve(white_both, white_r)
    plain = float(np.sum((white_r - white_own @ _solve(white_own, white_r)) ** 2))
    rich = float(np.sum((white_r - white_both @ theta) ** 2)) + 1e-30
    spent = np.linalg.matrix_rank(white_both, tol=1e-6)
    gained = max(int(spent - np.linalg.matrix_rank(white_own, tol=1e-6)), 1)
    free = max(len(r) - int(spent), 1)
    p_value = float(fisher.sf(max(plain - rich, 0.0) / gained / (rich / free), gained, free))
    profile = bumps @ (theta[-PIECES:] / (np.linalg.norm(B, axis=0) + 1e-12))
    left = r - both @ theta
    energy = max(float(already @ already - left @ left) / len(r), 0.0)
    return energy, p_value, float(grid[int(np.argmax(np.abs(profile)))])


def _solve(columns: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.linalg.lstsq(columns, y, rcond=1e-9)[0]


def _whiten(x: np.ndarray, ends: np.ndarray, noise: tuple[float, float]) -> np.ndarray:
    """Each drop's rows filtered so that noise of this colour becomes white."""
    memory, mix = noise
    return np.concatenate([lfilter([1.0, -memory], [1.0, mix], part, axis=0) for part in np.split(x, ends)])


def _colour(residuals: list[np.ndarray]) -> tuple[float, float]:
    """Memory and mix of first-order coloured plus white noise, each within +-1, by least squares of the innovations."""

    def misfit(x: np.ndarray) -> float:
        memory, mix = np.tanh(x)
        power = sum(float(np.sum(np.square(lfilter([1.0, -memory], [1.0, mix], r)))) for r in residuals)
        return float(np.log(power + 1e-30))

    tried = [minimize(misfit, s, method="Nelder-Mead", options={"maxiter": 60}) for s in STARTS]
    memory, mix = np.tanh(min(tried, key=lambda o: o.fun).x)
    return float(memory), float(np.clip(mix, -0.98, 0.98))

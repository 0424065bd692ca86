"""Whether a force that repeats from drop to drop is left over: then something the bank cannot name is missing."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline
from scipy.stats import chi2

from .fit import DropFit

PIECES = 10  # of the acceleration over the time since release


def repeating(fit: DropFit, times: list[np.ndarray], widening_of) -> tuple[float, float, float]:
    """Add a free acceleration over the time since release, the same in all drops, and see whether it pays.

    Args:
        fit: the best set of effects.
        times: sample times of each drop [s].
        widening_of: residuals -> how many samples are worth one.

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
    own = fit.jacobian  # whatever the effects and the releases could still take up is theirs
    theta = np.linalg.lstsq(np.column_stack([own, B]), r, rcond=1e-9)[0]
    left = r - np.column_stack([own, B]) @ theta
    already = r - own @ np.linalg.lstsq(own, r, rcond=1e-9)[0]
    ends = np.cumsum([len(t) for t in times])[:-1]
    worth = max(len(r) - own.shape[1] - PIECES, 4) / widening_of(np.split(left, ends))
    gain = worth * np.log(float(already @ already) / max(float(left @ left), 1e-12))
    profile = bumps @ theta[-PIECES:]
    energy = float(already @ already - left @ left) / len(r)
    return energy, float(chi2.sf(gain, PIECES)), float(grid[int(np.argmax(np.abs(profile)))])

"""How sure the numbers of a fitted set of drops are: the colour of the noise is not known either.

Few drops say little about how long their noise remembers, and a set fitted under the likeliest colour alone looks too
sure.  So every colour worth trying has its own estimate and its own errors (Student's t, as its size is fitted too),
weighed by its restricted likelihood; an interval holds 95 % of what they say together.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import stdtr

from .colour import Colour, likelihood
from .fit import DropFit

LEVEL = 0.95
UNLIKELY = 12.0  # log likelihood below the best from which on a colour does not count
HALVINGS = 50


def intervals(fit: DropFit, colours: Sequence[Colour]) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper ends of the 95 % intervals of effects and releases, (p,) each; infinite where nothing is known.

    Args:
        fit: of the drops.
        colours: of the noise, that are worth trying.
    """
    residual, jacobian = np.concatenate(fit.residuals), fit.jacobian
    x = np.concatenate([fit.theta, np.zeros(jacobian.shape[1] - len(fit.theta))])
    support = np.array([likelihood(c, residual, jacobian) for c in colours])
    likely = [(c, s) for c, s in zip(colours, support, strict=True) if s > support.max() - UNLIKELY]
    weight = np.exp([s - support.max() for _, s in likely])
    parts = [_under(c, residual, jacobian) for c, _ in likely]
    centre, error = x + np.array([p[0] for p in parts]), np.array([p[1] for p in parts])
    freedom = max(len(residual) - jacobian.shape[1], 1)
    low, high = (
        _quantile(q, centre, error, freedom, weight / weight.sum()) for q in (0.5 - LEVEL / 2.0, 0.5 + LEVEL / 2.0)
    )
    return low, high


def _under(which: Colour, residual: np.ndarray, jacobian: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Change of the estimate under a colour and its standard errors, (p,) each."""
    size = np.linalg.norm(jacobian, axis=0) + 1e-12
    J, r = which.apply(jacobian / size), which.apply(residual)
    u, s, vt = np.linalg.svd(J, full_matrices=False)
    keep = s > 1e-9 * s[0]
    step = vt[keep].T @ ((u[:, keep].T @ r) / s[keep])
    left = r - J @ step
    noise = left @ left / max(len(r) - len(s), 1)
    return step / size, np.sqrt(noise * np.sum((vt / np.maximum(s, 1e-9 * s[0])[:, None]) ** 2, axis=0)) / size


def _quantile(q: float, centre: np.ndarray, error: np.ndarray, freedom: int, weight: np.ndarray) -> np.ndarray:
    """Quantile of a mixture of Student's t, one column per number, by bisection."""
    low, high = (centre - 60.0 * error).min(axis=0), (centre + 60.0 * error).max(axis=0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = weight @ stdtr(freedom, (middle - centre) / (error + 1e-300)) < q
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)

"""The colour of the noise on a height: how long it remembers, and how much of it is slow.

A tracked body wanders by a pixel for several frames, so samples of one drop are not independent and least squares over
them would throw away most of what a slow change of the curve says.  The noise is taken as white plus exponentially
remembered; both numbers come from what the richest explanation leaves, by restricted likelihood, which counts what that
explanation took up itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular

SLOW = (0.3, 0.5, 0.7, 0.85, 0.97)
MEMORIES = 8
SHORT = 0.35  # of the step between samples: a shorter memory looks white


@dataclass(frozen=True, kw_only=True)
class Colour:
    """Noise of unit variance.

    Attributes:
        memory: after which the slow part has forgotten all but 1/e [s].
        slow: share of the variance that remembers.
        white: (n, n) per drop; times its noise gives independent samples of unit variance.
        volume: log determinant of the covariance, all drops together.
    """

    memory: float
    slow: float
    white: tuple[np.ndarray, ...]
    volume: float

    def apply(self, x: np.ndarray) -> np.ndarray:
        """Whiten rows (N,) or (N, k) stacked drop by drop."""
        at, out = 0, []
        for w in self.white:
            out.append(w @ x[at : at + len(w)])
            at += len(w)
        return np.concatenate(out)


def colour(times: Sequence[np.ndarray], memory: float, slow: float) -> Colour:
    """Noise of these two numbers at the drops' sample times [s]."""
    made: list[tuple[np.ndarray, np.ndarray]] = []
    white, volume = [], 0.0
    for t in sorted(times, key=len, reverse=True):
        since = t - t[0]
        # the factor of a shorter drop with the same steps is the corner of the longer one's
        known = next((w for s, w in made if np.allclose(s[: len(t)], since, atol=1e-4)), None)
        if known is None:
            away = np.abs(since[:, None] - since[None])
            factor = cholesky(slow * np.exp(-away / memory) + (1.0 - slow) * np.eye(len(t)), lower=True)
            known = solve_triangular(factor, np.eye(len(t)), lower=True)
            made.append((since, known))
    for t in times:
        since = t - t[0]
        w = next(w for s, w in made if len(s) >= len(t) and np.allclose(s[: len(t)], since, atol=1e-4))
        white.append(w[: len(t), : len(t)])
        volume += volume_of(white[-1])
    return Colour(memory=memory, slow=slow, white=tuple(white), volume=volume)


def volume_of(white: np.ndarray) -> float:
    """Log determinant of the covariance that (n, n) `white`, which is triangular, whitens."""
    return -2.0 * float(np.sum(np.log(np.diag(white))))


def grid(times: Sequence[np.ndarray]) -> list[Colour]:
    """Colours worth trying for these drops: white, and memories from below a sample to a tenth of a drop."""
    step = float(np.median([np.median(np.diff(t)) for t in times]))
    longest = max(0.1 * float(np.median([t[-1] - t[0] for t in times])), 2.0 * step)
    out = [colour(times, step, 0.0)]
    for memory in np.geomspace(SHORT * step, longest, MEMORIES):
        out += [colour(times, float(memory), slow) for slow in SLOW]
    return out


def likelihood(which: Colour, residual: np.ndarray, jacobian: np.ndarray) -> float:
    """Restricted log likelihood of a colour, up to a constant.

    Args:
        which: the colour.
        residual: (N,) what a fit leaves, stacked [m].
        jacobian: (N, p) how it changes with what was fitted.
    """
    size = np.linalg.norm(jacobian, axis=0) + 1e-12
    return restricted(which.apply(residual), which.apply(jacobian / size), which.volume)


def restricted(r: np.ndarray, J: np.ndarray, volume: float) -> float:
    """Restricted log likelihood of a noise of any size, up to a constant.

    Args:
        r: (N,) what a fit leaves, whitened.
        J: (N, p) how it changes with what was fitted, whitened, columns of about one size.
        volume: log determinant of the covariance that whitens them.
    """
    u, s, _ = np.linalg.svd(J, full_matrices=False)
    keep = s > 1e-6 * s[0]
    r = r - u[:, keep] @ (u[:, keep].T @ r)
    free = max(len(r) - int(keep.sum()), 1)
    return -0.5 * (free * float(np.log(r @ r / free + 1e-30)) + volume + 2.0 * float(np.sum(np.log(s[keep]))))


def estimated(which: Sequence[Colour], residual: np.ndarray, jacobian: np.ndarray) -> Colour:
    """The likeliest of some colours."""
    return max(which, key=lambda c: likelihood(c, residual, jacobian))

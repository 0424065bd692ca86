"""How sure the numbers of a fitted cloth are: by leaving out one coordinate of one marker in one recording at a time.

Markers err each on its own, with a memory of its own, and some are seen better than others.  The coordinates of all
markers in all recordings are many independent pieces, so how far the numbers move when one of them is left out says how
sure they are (jackknife), whatever the memory.  A number that rests on few pieces gets Student's t of few.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import t as student

LEVEL = 0.95
FEWEST = 2.0  # independent pieces a number rests on, below which nothing is known of how sure it is


def half_widths(columns: Sequence[np.ndarray], left: Sequence[np.ndarray]) -> np.ndarray:
    """Half-widths of 95 % intervals, (P,); infinite where a number rests on one piece alone.

    Args:
        columns: (T, C, P) per recording, change of the prediction with each number, weighted.
        left: (T, C) per recording, what the fit leaves, weighted.
    """
    pieces = [(X[:, c], y[:, c]) for X, y in zip(columns, left, strict=True) for c in range(y.shape[1])]
    square = np.array([X.T @ X for X, _ in pieces])  # (G, P, P)
    size = np.sqrt(np.einsum("gpp->p", square)) + 1e-12
    square = square / np.outer(size, size)
    pull = np.array([X.T @ y for X, y in pieces]) / size
    whole = square.sum(axis=0)
    moved = np.array(
        [np.linalg.pinv(whole - s, rcond=1e-8, hermitian=True) @ r for s, r in zip(square, pull, strict=True)]
    )
    inverse = np.linalg.pinv(whole, rcond=1e-8, hermitian=True)
    share = np.einsum("pi,gij,jp->gp", inverse, square, inverse)
    freedom = share.sum(axis=0) ** 2 / np.maximum(np.sum(share**2, axis=0), 1e-300)
    wide = student.ppf(0.5 + LEVEL / 2.0, np.maximum(freedom, 1.0))
    wide[freedom < FEWEST] = np.inf
    return wide * np.sqrt(np.sum(moved**2, axis=0) + 1e-300) / size

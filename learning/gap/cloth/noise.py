"""Noise of markers: what neighbouring markers do not share.

Sensors err marker by marker; a wrong model moves neighbouring markers together.  The product of neighbours' residuals
is therefore the model's share of the disagreement, whatever the colour of the noise in time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2, norm

MATERIAL_LOAD = 0.02  # of the load's range
STRETCHES = 8  # a recording is cut into to hear where it is loud


@dataclass(frozen=True, kw_only=True)
class Coherence:
    """Shared and unshared parts of a residual.

    Attributes:
        shared: mean square that neighbours share [m^2].
        floor: root mean square of the rest [m].
        p_value: of no sharing.
    """

    shared: float
    floor: float
    p_value: float


def neighbours(points: np.ndarray, count: int = 3) -> np.ndarray:
    """Pairs of each marker with its nearest ones, (P, 2)."""
    away = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(away, np.inf)
    near = np.argsort(away, axis=1)[:, : min(count, len(points) - 1)]
    return np.array([(i, j) for i, row in enumerate(near) for j in row]).reshape(-1, 2)


def coherence(residuals: list[np.ndarray], pairs: np.ndarray, markers: int) -> Coherence:
    """How much of the residual neighbours share.

    Args:
        residuals: (T, >= 3 M) per episode, markers first.
        pairs: (P, 2) neighbours.
        markers: M.
    """
    i, j = np.unique(np.sort(pairs, axis=1), axis=0).T if len(pairs) else (np.zeros(0, int), np.zeros(0, int))
    x = np.concatenate([r[:, : 3 * markers].reshape(len(r), markers, 3) for r in residuals])
    products = np.einsum("tkc,tkc->kc", x[:, i], x[:, j]) / len(x)  # (pairs, 3)
    total = float(np.mean(x**2))
    # were markers independent, each product's sign would be a coin's
    z = float(products.sum() / (np.sqrt(np.sum(products**2)) + 1e-30))
    together = float(products.mean()) if products.size else 0.0
    left = max(total - max(together, 0.0), 0.02 * total)
    return Coherence(shared=together, floor=float(np.sqrt(left)), p_value=float(norm.sf(z)))


def bursts(residuals: list[np.ndarray], markers: int) -> float:
    """P-value of the markers being as loud in every stretch of time as in the middle one, over all recordings.

    Cloth that buckles the other way than the model moves its markers by much, and neighbours against each other.

    Args:
        residuals: (T, >= 3 M) per episode, markers first.
        markers: M.
    """
    parts = [p for r in residuals for p in np.array_split(r[:, : 3 * markers], STRETCHES)]
    loud = np.array([np.mean(p**2, axis=0) for p in parts])  # (stretches, 3 M)
    usual = np.median(loud, axis=0) + 1e-30
    columns = float(usual.sum() ** 2 / np.sum(usual**2))
    # within a stretch a column may be all memory, so it counts once
    ratio = float(np.max(loud.mean(axis=1)) / np.median(loud.mean(axis=1)))
    return min(1.0, len(parts) * float(chi2.sf(columns * ratio, columns)))


def memory(residuals: list[np.ndarray]) -> float:
    """How many samples are worth one: long-run over plain variance, pooled over columns, at least 1."""
    zero = sum(float(np.sum(r**2)) for r in residuals) + 1e-30
    running = best = 1.0
    for k in range(1, max(2, min(len(r) for r in residuals) // 4)):
        running += 2.0 * sum(float(np.sum(r[k:] * r[:-k])) for r in residuals) / zero
        best = max(best, running)
    return best


def load_misfit(residuals: list[np.ndarray], loads: list[np.ndarray | None], markers: int) -> float:
    """P-value of the load at the first pin being right; 1 where none was measured or the error is immaterial.

    Args:
        residuals: (T, 3 M + 3) per episode where a load was measured.
        loads: (T, 3) measured [N] per episode, or None.
        markers: M.
    """
    given = [(r[:, 3 * markers :], load) for r, load in zip(residuals, loads, strict=True) if load is not None]
    if not given:
        return 1.0
    error = float(np.mean([np.mean(r**2) for r, _ in given]))
    # what second differences leave is noise of the cell; what is slower is the model's
    noise = float(np.mean([np.mean(np.diff(r, 2, axis=0) ** 2) / 6.0 for r, _ in given])) + 1e-12
    if error < (MATERIAL_LOAD * max(float(np.ptp(load)) for _, load in given)) ** 2:
        return 1.0
    parts = [r for r, _ in given]
    worth = max(sum(r.size for r in parts) / memory(parts), 1.0)
    return float(chi2.sf(worth * error / noise, worth))

"""The paper's error measure and what is said about it.

    M_eg = mean over parameters of |P_g - P_e| / P_g

with P_g the true and P_e the estimated value, in the parameters' own units (not in the unit interval).
"""

from __future__ import annotations

import numpy as np

BOOTSTRAPS = 1000


def relative_errors(true: np.ndarray, estimated: np.ndarray) -> np.ndarray:
    """|P_g - P_e| / P_g of each parameter: (N, K), (N, K) values in their own units -> (N, K)."""
    return np.abs(true - estimated) / np.abs(true)


def garment_error(true: np.ndarray, estimated: np.ndarray, parameters: list[int] | None = None) -> np.ndarray:
    """M_eg of each clip: (N,), over the chosen parameters (columns; None: all)."""
    errors = relative_errors(true, estimated)
    return (errors if parameters is None else errors[:, parameters]).mean(axis=1)


def median_interval(values: np.ndarray, *, level: float = 0.95, seed: int = 0) -> tuple[float, float, float]:
    """Median of (N,) values and its bootstrap interval: median, lower, upper."""
    rng = np.random.default_rng(seed)
    drawn = np.median(values[rng.integers(len(values), size=(BOOTSTRAPS, len(values)))], axis=1)
    lower, upper = np.quantile(drawn, [(1 - level) / 2, (1 + level) / 2])
    return float(np.median(values)), float(lower), float(upper)


def coverage(true: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Share of clips whose true value lies in its interval, for each parameter: (N, K) x 3 -> (K,)."""
    return ((true >= lower) & (true <= upper)).mean(axis=0)

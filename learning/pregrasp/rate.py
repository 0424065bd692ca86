"""Rates with the interval that their number supports, and whether two ways differ on the same states."""

from __future__ import annotations

import math

import numpy as np

Z95 = 1.959964  # two-sided 95 % of the normal distribution


def wilson(hits: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a proportion; all of [0, 1] without trials."""
    if n == 0:
        return 0.0, 1.0
    share, square = hits / n, Z95 * Z95
    middle = (share + square / (2 * n)) / (1 + square / n)
    half = Z95 * math.sqrt(share * (1 - share) / n + square / (4 * n * n)) / (1 + square / n)
    return max(0.0, middle - half), min(1.0, middle + half)


def rate_text(won: np.ndarray) -> str:
    """`9/10 = 90 % (60 to 98)` of (n,) bool, or `-` of none."""
    if len(won) == 0:
        return "-"
    low, high = wilson(int(won.sum()), len(won))
    return f"{int(won.sum())}/{len(won)} = {100 * won.mean():.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def signs(one: np.ndarray, other: np.ndarray) -> tuple[int, int, float]:
    """States that only `one` wins, that only `other` wins, and the p-value of the two-sided sign test (McNemar)."""
    from scipy.stats import binomtest

    mine, theirs = int((one & ~other).sum()), int((other & ~one).sum())
    p = float(binomtest(mine, mine + theirs).pvalue) if mine + theirs else 1.0
    return mine, theirs, p


def area_under_curve(told: np.ndarray, won: np.ndarray, seed: int = 0) -> tuple[float, float, float]:
    """Area under the ROC curve of scores (n,) for `won` (n,) bool, and its 95 % interval by 1,000 bootstrap samples.

    It is the chance that a success is scored higher than a failure, a tie counting half; NaN where one sort is missing.
    """
    from scipy.stats import rankdata

    def area(told: np.ndarray, won: np.ndarray) -> float:
        hits = int(won.sum())
        pairs = hits * (len(won) - hits)
        return float((rankdata(told)[won].sum() - hits * (hits + 1) / 2) / pairs) if pairs else math.nan

    rng = np.random.default_rng([seed, 25])
    drawn = [rng.integers(len(won), size=len(won)) for _ in range(1000)]
    low, high = np.nanpercentile([area(told[k], won[k]) for k in drawn], (2.5, 97.5))
    return area(told, won), float(low), float(high)

"""From the value of a policy's best action to the chance of its success, and how far off that chance is."""

from __future__ import annotations

import numpy as np

BINS = 10
PRIOR = 1.0  # successes and failures that are put beside those seen, so that a steep fit stays finite


def fit_chance(values: np.ndarray, won: np.ndarray) -> tuple[float, float]:
    """Scale and shift of the logit of success of actions of values (n,), of which some have won (n,) bool."""
    from scipy.optimize import minimize

    middle, width = float(values.mean()), float(values.std()) + 1e-6
    x, target = (values - middle) / width, (won * len(won) + PRIOR) / (len(won) + 2 * PRIOR)

    def loss(p: np.ndarray) -> float:
        logit = p[0] * x + p[1]
        return float(np.mean(np.logaddexp(0.0, logit) - target * logit))

    scale, shift = minimize(loss, np.array((1.0, 0.0))).x
    return float(scale / width), float(shift - scale * middle / width)


def calibration_error(told: np.ndarray, won: np.ndarray) -> float:
    """Expected calibration error of chances (n,) that were told, in ten bins of equal width."""
    bins = np.minimum((told * BINS).astype(int), BINS - 1)
    off = [abs((told[bins == k] - won[bins == k]).sum()) for k in range(BINS)]
    return float(np.sum(off) / len(told))

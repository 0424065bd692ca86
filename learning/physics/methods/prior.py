"""What is known of the parameters before a clip is seen: nothing, or that they are of one of the training classes."""

from __future__ import annotations

import numpy as np

FLOOR = 1e-3  # smallest standard deviation inside a class, in [0, 1]


class Prior:
    """A mixture of equal normal distributions around the classes' means.

    Args:
        means: (C, P) of the classes in [0, 1]; C = 0 says that there are no classes.
        variance: (P,) inside a class.
    """

    def __init__(self, means: np.ndarray, variance: np.ndarray) -> None:
        self.means, self.variance = means, variance

    def combine(self, unit: np.ndarray, deviation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean and deviation after the prior is taken into account.

        Args:
            unit: (N, P) estimates from the clips.
            deviation: (N, P) their standard deviations.

        Returns:
            (N, P) means, (N, P) standard deviations.
        """
        if not len(self.means):
            return unit, deviation
        squares = deviation**2
        total = squares + self.variance  # (N, P) of the distance between estimate and class mean
        away = unit[:, None] - self.means  # (N, C, P)
        evidence = -0.5 * (away**2 / total[:, None]).sum(axis=2)
        share = np.exp(evidence - evidence.max(axis=1, keepdims=True))
        share /= share.sum(axis=1, keepdims=True)
        pull = (self.variance / total)[:, None]  # how far from the class mean towards the estimate
        each = self.means + pull * away
        mean = (share[..., None] * each).sum(axis=1)
        between = (share[..., None] * (each - mean[:, None]) ** 2).sum(axis=1)
        return mean, np.sqrt(self.variance * squares / total + between)


def fit_prior(unit: np.ndarray, class_id: np.ndarray) -> Prior:
    """Prior from training parameters (N, P) and their classes (N,), negative where there are none."""
    if (class_id < 0).any():
        return Prior(np.empty((0, unit.shape[1])), np.ones(unit.shape[1]))
    classes, which = np.unique(class_id, return_inverse=True)
    means = np.array([unit[which == c].mean(axis=0) for c in range(len(classes))])
    inner = unit - means[which]
    return Prior(means, (inner**2).sum(axis=0) / max(1, len(unit) - len(classes)) + FLOOR**2)

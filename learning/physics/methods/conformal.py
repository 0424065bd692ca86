"""Intervals that keep their promise: widths measured on clips that took no part in the fit (conformal prediction).

How wrong an estimate is differs over the range (a heavy gown's drag hardly shows).  So each parameter's deviation at a
place is the root mean square error of the validation clips estimated nearest to it.  The errors of the validation
clips in units of that deviation, each computed without the clip itself, then give the factor that makes 90 % of the
intervals contain the truth, for clips that come from where the validation clips came from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LEVEL = 0.9
NEAREST = 40  # validation clips that say how large errors are here
FLOOR = 1e-4  # smallest deviation, in [0, 1]


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """What the validation clips say of errors.

    Attributes:
        places: (V, P) estimates in [0, 1].
        errors: (V, P) absolute errors.
        usual_misfit: median misfit of these clips; one explained worse gets wider intervals.
        factor: (P,) half an interval in units of the deviation.
    """

    places: np.ndarray
    errors: np.ndarray
    usual_misfit: float
    factor: np.ndarray

    def deviation(self, unit: np.ndarray, misfit: np.ndarray, *, skip_self: bool = False) -> np.ndarray:
        """Deviation to be expected of estimates: (N, P), (N,) misfits -> (N, P)."""
        distance = np.linalg.norm(unit[:, None] - self.places, axis=2)
        if skip_self:
            np.fill_diagonal(distance, np.inf)
        count = min(NEAREST, max(1, len(self.places) // 3))
        near = np.argpartition(distance, count - 1, axis=1)[:, :count]
        local = np.sqrt((self.errors[near] ** 2).mean(axis=1)) + FLOOR
        return local * np.maximum(1.0, misfit / self.usual_misfit)[:, None]

    def intervals(self, unit: np.ndarray, misfit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper ends in [0, 1] of estimates (N, P) with misfits (N,)."""
        half = self.deviation(unit, misfit) * self.factor
        return np.clip(unit - half, 0.0, 1.0), np.clip(unit + half, 0.0, 1.0)


def calibrate(true: np.ndarray, estimated: np.ndarray, misfit: np.ndarray, level: float = LEVEL) -> Calibration:
    """Calibration from validation clips: (V, P), (V, P), (V,).

    The quantile has the correction for finite samples: rank ceil((V + 1) level) of V, the largest at most.
    """
    errors = np.abs(true - estimated)
    raw = Calibration(
        places=estimated, errors=errors, usual_misfit=float(np.median(misfit)) + 1e-12, factor=np.ones(true.shape[1])
    )
    ratios = np.sort(errors / raw.deviation(estimated, misfit, skip_self=True), axis=0)
    rank = min(len(ratios), int(np.ceil((len(ratios) + 1) * level)))
    return Calibration(places=estimated, errors=errors, usual_misfit=raw.usual_misfit, factor=ratios[rank - 1])

"""Ours: a Gaussian process on principal components, corrected by simulating its answer, with calibrated intervals.

Fitting takes seconds: compression.py, gaussian_process.py, prior.py and, from the validation clips, conformal.py.
Identifying a clip reads the parameters off the process; given a simulator of the gown, indirect.py then looks for the
parameters whose simulated clip gets the same answer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from .compression import Compression, fit_compression
from .conformal import Calibration, calibrate
from .gaussian_process import GaussianProcess, fit_gaussian_process
from .indirect import match
from .method import Examples, Method
from .prior import Prior, fit_prior

SCORES = 128
ROUNDS = 9  # steps of the correction

Film = Callable[[np.ndarray], torch.Tensor]
"""Simulates clips: parameters (N, P) in [0, 1] -> frames (N, T, 2, S, S)."""


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """What is said of each clip, in [0, 1].

    Attributes:
        unit: (N, P) parameters.
        lower: (N, P) lower ends of the 90 % intervals.
        upper: (N, P) upper ends.
        misfit: (N,) distance, in scores, of the clip from the nearest one known, or from the one simulated.
    """

    unit: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    misfit: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Widths:
    """Calibrations of one way of identifying.

    Attributes:
        before: of what the clip alone says.
        after: once the prior is taken into account.
    """

    before: Calibration
    after: Calibration


class Inversion(Method):
    """The fitted method.

    Args:
        compression: frames -> scores.
        process: scores -> parameters.
        prior: classes of the parameters, if any.
        widths: calibrations, `alone` and, once calibrated with a simulator, `simulated`.
        shown: indices of the parameters that a clip shows; simulating again moves only these.
    """

    name = "ours"

    def __init__(self, compression: Compression, process: GaussianProcess, prior: Prior,
                 widths: dict[str, Widths], shown: tuple[int, ...]) -> None:  # fmt: skip
        self.compression, self.process, self.prior, self.widths = compression, process, prior, widths
        self.shown = list(shown)

    def alone(self, frames: torch.Tensor) -> tuple[np.ndarray, np.ndarray]:
        """What the process says: (N, P) parameters, (N,) distance to the nearest known clip."""
        scores = self.compression(frames)
        distance = torch.cdist(scores, self.process.inputs).min(dim=1).values
        return self.process(scores).double().numpy(), distance.double().numpy()

    def simulated(self, frames: torch.Tensor, film: Film, rounds: int = ROUNDS) -> tuple[np.ndarray, np.ndarray]:
        """The same after correction: (N, P) parameters, (N,) distance to the simulated clip."""
        wanted, novelty = self.alone(frames)
        seen = self.compression(frames)

        def answers(shown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            unit = np.clip(wanted, 0.0, 1.0)
            unit[:, self.shown] = shown
            scores = self.compression(film(unit))
            return self.process(scores).double().numpy()[:, self.shown], (scores - seen).norm(dim=1).double().numpy()

        unsure = self.widths["alone"].before.deviation(wanted, novelty)
        found = wanted.copy()
        found[:, self.shown], misfit = match(answers, wanted[:, self.shown], unsure[:, self.shown], rounds)
        return found, misfit

    def infer(self, frames: torch.Tensor, film: Film | None = None) -> Estimate:
        """Parameters and intervals of each clip.

        Args:
            frames: (N, T, 2, S, S).
            film: simulates the gown of these clips; None: the process alone.
        """
        if film is None:
            return self.judged("alone", *self.alone(frames))
        return self.judged("simulated", *self.simulated(frames, film))

    def judged(self, way: str, unit: np.ndarray, misfit: np.ndarray) -> Estimate:
        """The prior and intervals added to what `alone` or `simulated` found."""
        widths = self.widths[way]
        unit, _ = self.prior.combine(unit, widths.before.deviation(unit, misfit))
        unit = np.clip(unit, 0.0, 1.0)
        lower, upper = widths.after.intervals(unit, misfit)
        return Estimate(unit=unit, lower=lower, upper=upper, misfit=misfit)

    def estimate(self, frames: torch.Tensor) -> np.ndarray:
        """Parameters by the process alone."""
        return self.infer(frames).unit

    def calibrate(self, valid: Examples, film: Film | None = None) -> None:
        """Set the widths of the intervals from clips that took no part in the fit."""
        found = self.alone(valid.frames) if film is None else self.simulated(valid.frames, film)
        self.set_widths("alone" if film is None else "simulated", valid.unit, *found)

    def set_widths(self, way: str, true: np.ndarray, unit: np.ndarray, misfit: np.ndarray) -> None:
        """The same from estimates made before: `alone` or `simulated`, (V, P), (V, P), (V,)."""
        before = calibrate(true, unit, misfit)
        combined, _ = self.prior.combine(unit, before.deviation(unit, misfit, skip_self=True))
        after = calibrate(true, np.clip(combined, 0.0, 1.0), misfit)
        self.widths[way] = Widths(before=before, after=after)


def fit_ours(train: Examples, valid: Examples, *, seed: int, shown: tuple[int, ...]) -> Inversion:
    """Fit everything; the intervals of the corrected estimates still want `calibrate` with a simulator."""
    compression = fit_compression(train.frames, SCORES, seed)
    process = fit_gaussian_process(compression(train.frames), torch.from_numpy(train.unit).float(), seed)
    method = Inversion(compression, process, fit_prior(train.unit, train.class_id), {}, shown)
    method.calibrate(valid)
    return method

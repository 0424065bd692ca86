"""One sort of clips: a Gaussian process on principal components, corrected by simulating its answer, with intervals.

Fitting takes seconds: pca.py, gaussian_process.py, prior.py and, from the validation clips, conformal.py. Identifying a
clip reads the parameters off the process; given a simulator of the gown, indirect_inference.py then looks for the
parameters whose simulated clip gets the same answer, or, where the process has learned little of such gowns,
discrepancy.py learns how it errs for this gown.  A process fitted to rough clips also says how far the camera was from
where the clip says, and the simulated camera is moved along with the parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..clips.camera import MISPLACED
from .conformal import Calibration, calibrate
from .discrepancy import follow
from .gaussian_process import GaussianProcess, fit_gaussian_process
from .indirect_inference import match
from .method import Examples
from .pca import Compression, fit_compression
from .prior import Prior, fit_prior

SCORES = 128
ROUNDS = 9  # steps of the correction
SIMULATIONS = 20  # of a clip that a blunt process reads: what two seconds allow
CAMERA_UNIT = 10.0 * MISPLACED  # in which the process says how far the camera is misplaced
CAMERA_UNSURE = 0.03  # of these, in the process's word
FAR = 0.4  # the most that is looked for

ClipSimulator = Callable[..., Any]
"""Simulates clips: parameters (N, P) in [0, 1] and, of rough clips, (N, 6) camera errors -> frames (N, T, 2, S, S)."""


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


class Inversion:
    """The fitted method for one sort of clips.

    Args:
        compression: frames -> scores.
        process: scores -> parameters and, of rough clips, six camera errors in `CAMERA_UNIT`.
        prior: classes of the parameters, if any.
        widths: calibrations by way: `alone`, `simulated`.
        shown: indices of the parameters that a clip shows; simulating again moves only these.
    """

    def __init__(self, compression: Compression, process: GaussianProcess, prior: Prior,
                 widths: dict[str, Widths], shown: tuple[int, ...]) -> None:  # fmt: skip
        self.compression, self.process, self.prior, self.widths = compression, process, prior, widths
        self.shown = list(shown)
        self.parameters = prior.means.shape[1]

    def alone(self, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What the process says: (N, P) parameters, (N,) distance to the nearest known clip."""
        scores = self.compression(frames)
        return self.process(scores)[:, : self.parameters], self.process.distance(scores)

    def simulated(
        self, frames: np.ndarray, simulate: ClipSimulator, *, blunt: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same after correction: (N, P) parameters, (N,) distance to the simulated clip.

        Args:
            frames: of the clips.
            simulate: renders such clips.
            blunt: whether these gowns have a cut that the process knows little of; without effect where the camera is
                looked for too.
        """
        seen, p = self.compression(frames), self.parameters
        said, novelty = self.process(seen), self.process.distance(seen)
        if blunt and said.shape[1] == p:
            return self._followed(seen, said, simulate)
        camera = list(range(p, said.shape[1]))
        moved = self.shown + camera  # what simulating again moves

        def answers(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            every = np.clip(said, 0.0, 1.0)
            every[:, moved] = values
            unit = every[:, :p]
            scores = self.compression(simulate(unit, every[:, p:] * CAMERA_UNIT) if camera else simulate(unit))
            return self.process(scores)[:, moved], np.linalg.norm(scores - seen, axis=1)

        unsure = np.hstack(
            [
                self.widths["alone"].before.deviation(said[:, :p], novelty)[:, self.shown],
                np.full((len(said), len(camera)), CAMERA_UNSURE),
            ]
        )
        # the camera's slopes are cheap to measure: the gown's fall stays the same
        low, high = (np.array([gown] * len(self.shown) + [far] * len(camera)) for gown, far in ((0, -FAR), (1, FAR)))
        found = said[:, :p].copy()
        matched, misfit = match(
            answers, said[:, moved], unsure, ROUNDS, low=low, high=high, measure=range(len(self.shown), len(moved))
        )
        found[:, self.shown] = matched[:, : len(self.shown)]
        return found, misfit

    def _followed(self, seen: np.ndarray, said: np.ndarray, simulate: ClipSimulator) -> tuple[np.ndarray, np.ndarray]:
        def scores(values: np.ndarray) -> np.ndarray:
            unit = np.clip(said, 0.0, 1.0)
            unit[:, self.shown] = values
            return self.compression(simulate(unit))

        found = said.copy()
        found[:, self.shown], misfit = follow(
            scores, lambda some: self.process(some)[:, self.shown], self.process.lengths[self.shown], seen, SIMULATIONS
        )
        return found, misfit

    def judged(self, way: str, unit: np.ndarray, misfit: np.ndarray) -> Estimate:
        """The prior and intervals added to what `alone` or `simulated` found; the way says which widths hold."""
        widths = self.widths[way]
        unit, _ = self.prior.combine(unit, widths.before.deviation(unit, misfit))
        unit = np.clip(unit, 0.0, 1.0)
        lower, upper = widths.after.intervals(unit, misfit)
        return Estimate(unit=unit, lower=lower, upper=upper, misfit=misfit)

    def set_widths(self, way: str, true: np.ndarray, unit: np.ndarray, misfit: np.ndarray) -> None:
        """Set the widths of the intervals of one way from clips that took no part in the fit.

        Args:
            way: see `widths`.
            true: (V, P) of these clips.
            unit: (V, P) as `alone` or `simulated` found them.
            misfit: (V,) likewise.
        """
        before = calibrate(true, unit, misfit)
        combined, _ = self.prior.combine(unit, before.deviation(unit, misfit, skip_self=True))
        after = calibrate(true, np.clip(combined, 0.0, 1.0), misfit)
        self.widths[way] = Widths(before=before, after=after)


def fit_inversion(train: Examples, valid: Examples, *, seed: int, shown: tuple[int, ...]) -> Inversion:
    """Fit one sort of clips: with the camera where that is misplaced; the widths of `alone` are set."""
    compression = fit_compression(train.frames, SCORES, seed)
    wanted = train.unit
    if train.misplaced is not None and train.misplaced.any():
        wanted = np.hstack([wanted, train.misplaced / CAMERA_UNIT])
    process = fit_gaussian_process(compression(train.frames), wanted, seed)
    inversion = Inversion(compression, process, fit_prior(train.unit, train.class_id), {}, shown)
    inversion.set_widths("alone", valid.unit, *inversion.alone(valid.frames))
    return inversion

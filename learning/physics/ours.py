"""Ours: an inversion (inversion.py) for each sort of clips that was trained on, clean ones and rough ones.

Rough clips have the gaps of a real camera, which is seen from the clip itself (mend.py).  They want another compression
and another process than rendered clips: noise hides small motions, and the camera is not quite where the clip says.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .inversion import Estimate, Film, Inversion, fit_inversion
from .method import Examples, Method

OTHER = "_other"  # behind the name of a way: the clip shows a cut that was not trained on
LEAST = 20  # clips of a sort, below which nothing is fitted to it

Films = Callable[[np.ndarray], Film]
"""Indices of clips (M,) -> what simulates their gowns, in this order."""


class Ours(Method):
    """The fitted method.

    Args:
        clean: for clips without gaps.
        rough: for clips with gaps; None: nothing was trained on such.
    """

    name = "ours"

    def __init__(self, clean: Inversion, rough: Inversion | None = None) -> None:
        self.clean, self.rough = clean, rough

    def sort(self, rough: bool) -> Inversion:
        """The inversion that reads such clips."""
        return self.rough if rough and self.rough is not None else self.clean

    def raw(self, clips: Examples, films: Films | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Parameters (N, P) and misfits (N,) before the prior, corrected by simulation where `films` are given."""
        unit, misfit = np.empty_like(clips.unit), np.empty(len(clips))
        for rough in (False, True):
            index = np.flatnonzero(clips.gaps == rough)
            if len(index):
                inversion = self.sort(rough)
                if films is None:
                    unit[index], misfit[index] = inversion.alone(clips.frames[index])
                    continue
                for one in index[:, None]:  # each for itself: some need few rounds
                    unit[one], misfit[one] = inversion.simulated(clips.frames[one], films(one))
        return unit, misfit

    def judged(self, way: str, rough: np.ndarray, unit: np.ndarray, misfit: np.ndarray) -> Estimate:
        """The prior and intervals added to what `raw` found of clips that are rough or not, (N,).

        The way is `alone` or `simulated`, with `OTHER` behind it where that was calibrated.
        """
        parts = {name: np.empty_like(unit) for name in ("unit", "lower", "upper")}
        for sort in (False, True):
            index = np.flatnonzero(rough == sort)
            if len(index):
                inversion = self.sort(sort)
                known = way if way in inversion.widths else way.removesuffix(OTHER)
                found = inversion.judged(known, unit[index], misfit[index])
                for name, part in parts.items():
                    part[index] = getattr(found, name)
        return Estimate(misfit=misfit, **parts)

    def infer(self, clips: Examples, films: Films | None = None, *, other: bool = False) -> Estimate:
        """Parameters and intervals of each clip.

        Args:
            clips: of which only the frames and the sort are looked at.
            films: make a simulator of the gowns of some of these clips; None: the processes alone.
            other: whether these gowns have a cut that was not trained on.
        """
        way = ("alone" if films is None else "simulated") + (OTHER if other else "")
        return self.judged(way, clips.gaps, *self.raw(clips, films))

    def estimate(self, frames: Any) -> np.ndarray:
        """Parameters of clean clips, by the process alone."""
        return self.clean.judged("alone", *self.clean.alone(frames)).unit


def fit_ours(train: Examples, valid: Examples, *, seed: int, shown: tuple[int, ...]) -> Ours:
    """Fit everything; the intervals of the corrected estimates still want `set_widths`."""
    def fit(rough: bool) -> Inversion:
        return fit_inversion(train.part(train.gaps == rough), valid.part(valid.gaps == rough), seed=seed, shown=shown)

    return Ours(fit(False), fit(True) if min(train.gaps.sum(), valid.gaps.sum()) >= LEAST else None)

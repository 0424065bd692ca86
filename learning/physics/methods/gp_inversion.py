"""GP inversion: one inversion by a Gaussian process (inversion.py) for each sort of clips that was trained on.

Rough clips have the gaps of a real camera, which is seen from the clip itself (depth_holes.py).  They need another
compression and another process than rendered clips: noise hides small motions, and the camera is not quite where the
clip says. Gowns of other cuts than the usual one hang and fall differently: they need processes that learned from many
cuts.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .inversion import ClipSimulator, Estimate, Inversion, fit_inversion
from .method import Examples, Method

LEAST = 20  # clips of a sort, below which nothing is fitted to it
SORTS = {(False, False): "clean", (True, False): "rough", (False, True): "clean_other", (True, True): "rough_other"}
"""Whether clips are rough, and of another cut -> what such clips are called."""

ClipSimulators = Callable[[np.ndarray], ClipSimulator]
"""Indices of clips (M,) -> what simulates their gowns, in this order."""


class GPInversion(Method):
    """The fitted method: one inversion for each sort of clips.

    Args:
        inversions: for the sorts of clips in `SORTS` that were trained on; `clean` is one of them.
    """

    name = "gp_inversion"

    def __init__(self, inversions: dict[str, Inversion]) -> None:
        self.inversions = inversions

    def sort(self, rough: bool, other: bool = False) -> Inversion:
        """The inversion that reads clips that are rough or not, of another cut or not, or the next best one."""
        wanted = ((rough, other), (rough, False), (False, other), (False, False))
        return next(self.inversions[SORTS[sort]] for sort in wanted if SORTS[sort] in self.inversions)

    def raw(
        self, clips: Examples, simulators: ClipSimulators | None = None, *, other: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Parameters (N, P) and misfits (N,) before the prior, corrected by simulation where `simulators` are given."""
        unit, misfit = np.empty_like(clips.unit), np.empty(len(clips))
        for rough in (False, True):
            index = np.flatnonzero(clips.gaps == rough)
            if len(index):
                inversion = self.sort(rough, other)
                if simulators is None:
                    unit[index], misfit[index] = inversion.alone(clips.frames[index])
                    continue
                for one in index[:, None]:  # each for itself: some need few rounds
                    unit[one], misfit[one] = inversion.simulated(clips.frames[one], simulators(one), blunt=other)
        return unit, misfit

    def judged(self, way: str, rough: np.ndarray, unit: np.ndarray, misfit: np.ndarray, *,
               other: bool = False) -> Estimate:  # fmt: skip
        """The prior and intervals added to what `raw` found of clips that are rough or not, (N,).

        The way is `alone` or `simulated`.
        """
        parts = {name: np.empty_like(unit) for name in ("unit", "lower", "upper")}
        for sort in (False, True):
            index = np.flatnonzero(rough == sort)
            if len(index):
                found = self.sort(sort, other).judged(way, unit[index], misfit[index])
                for name, part in parts.items():
                    part[index] = getattr(found, name)
        return Estimate(misfit=misfit, **parts)

    def infer(self, clips: Examples, simulators: ClipSimulators | None = None, *, other: bool = False) -> Estimate:
        """Parameters and intervals of each clip.

        Args:
            clips: of which only the frames and the sort are looked at.
            simulators: make a simulator of the gowns of some of these clips; None: the processes alone.
            other: whether these gowns have another cut than the usual one.
        """
        found = self.raw(clips, simulators, other=other)
        return self.judged("alone" if simulators is None else "simulated", clips.gaps, *found, other=other)

    def estimate(self, frames: Any) -> np.ndarray:
        """Parameters of clean clips of the usual cut, by the process alone."""
        clean = self.sort(False)
        return clean.judged("alone", *clean.alone(frames)).unit


def fit_gp_inversion(train: Examples, valid: Examples, others: tuple[Examples, Examples] | None = None, *, seed: int,
             shown: tuple[int, ...]) -> GPInversion:  # fmt: skip
    """Fit everything; the intervals of the corrected estimates still want `set_widths`.

    Args:
        train: clips of the usual cut.
        valid: more of them, for the intervals.
        others: both of other cuts, if any.
        seed: of what is drawn.
        shown: indices of the parameters that a clip shows.
    """
    inversions = {}
    for (rough, other), name in SORTS.items():
        if other and others is None:
            continue
        learn, check = (part.part(part.gaps == rough) for part in (others if other and others else (train, valid)))
        if name == "clean" or min(len(learn), len(check)) >= LEAST:
            inversions[name] = fit_inversion(learn, check, seed=seed, shown=shown)
    return GPInversion(inversions)

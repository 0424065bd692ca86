"""What learns nothing: the paper's baselines 4 and 5, a person's setting and chance, and the centres of classes."""

from __future__ import annotations

import itertools

import numpy as np

from ..clips.parameters import BASE, NAMES
from ..methods.gaussian_process import squared_distances
from ..methods.method import Examples, Method

MASSES = (0.2, 0.45, 0.8)  # a light, a usual and a heavy gown [kg]
STIFFNESSES = (0.5, 1.0, 3.0)  # soft, usual and stiff cloth, times the base values


class ManualTuning(Method):
    """Baseline 4: of a few settings a person would try, the one whose clip looks most like the one seen.

    Args:
        unit: (S, 6) the settings.
        frames: (S, T, 2, H, W) the clip of each, simulated with the usual gown.
    """

    name = "manual"

    def __init__(self, unit: np.ndarray, frames: np.ndarray) -> None:
        self.unit, self.frames = unit, _flat(frames)

    def estimate(self, frames: np.ndarray) -> np.ndarray:
        """The setting with the smallest mean square difference of frames."""
        parts = [
            squared_distances(_flat(frames[i : i + 256]), self.frames).argmin(axis=1)
            for i in range(0, len(frames), 256)
        ]
        return self.unit[np.concatenate(parts)]


def _flat(frames: np.ndarray) -> np.ndarray:
    return frames.reshape(len(frames), -1).astype(float)


def settings() -> np.ndarray:
    """(9, 6) what a person would try, in the parameters' own units: three weights of three materials."""
    rows = []
    for mass, stiffness in itertools.product(MASSES, STIFFNESSES):
        row = BASE.copy()
        row[NAMES.index("mass")] = mass
        for name in ("elastic", "bending"):
            row[NAMES.index(name)] *= stiffness
        rows.append(row)
    return np.array(rows)


class RandomParameters(Method):
    """Baseline 5: uniform over the range.

    Args:
        seed: of the draw.
        parameters: how many.
    """

    name = "random"

    def __init__(self, seed: int, parameters: int = len(NAMES)) -> None:
        self.seed, self.parameters = seed, parameters

    def estimate(self, frames: np.ndarray) -> np.ndarray:
        """Draws, whatever the clip."""
        return np.random.default_rng(self.seed).random((len(frames), self.parameters))


def class_centres(train: Examples, class_id: np.ndarray) -> np.ndarray:
    """What a method that recognised the class, and saw no more, would say.

    No method: it is told the class.  Its error is the one that has to be undercut to have seen anything inside a class.

    Args:
        train: clips whose mean parameters are the centres.
        class_id: (N,) of the clips in question, each a class of `train`.

    Returns:
        (N, 6) in [0, 1].
    """
    centres = {one: train.unit[train.class_id == one].mean(axis=0) for one in np.unique(train.class_id)}
    return np.array([centres[one] for one in class_id])

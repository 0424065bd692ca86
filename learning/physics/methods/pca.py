"""Principal components of frames: a clip of 30,000 numbers becomes about a hundred."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

CHUNK = 512  # clips at a time
CLIPS = 1500  # that choose the directions; more change them little and cost more than all the rest of the fit
LEAST = 1e-3  # spread of a direction over the largest, below which it is rounding


@dataclass(frozen=True, kw_only=True)
class Compression:
    """Linear: scores of a clip along the directions in which the training clips differ most.

    Each score is divided by the root of its spread, half-way between leaving the scores as they are, where the few
    directions of the large motion drown the rest, and giving all the same weight, where pixel noise does.

    Attributes:
        mean: (D,) float32 of the flattened frames.
        components: (D, K) float32 or int8, orthogonal, each as whole numbers up to 127, which take one byte to keep.
        scale: (K,) what each score is multiplied by.
    """

    mean: np.ndarray
    components: np.ndarray
    scale: np.ndarray

    def __call__(self, frames: np.ndarray) -> np.ndarray:
        """Scores: (N, T, 2, S, S) -> (N, K) float64, whose mean square length is one over the training clips."""
        parts = [(_flat(frames[i : i + CHUNK]) - self.mean) @ self._directions for i in range(0, len(frames), CHUNK)]
        return np.concatenate(parts).astype(float) * self.scale

    @cached_property
    def _directions(self) -> np.ndarray:
        """The components as float32; of the sorts of clips in a file of weights, most are not needed."""
        return self.components.astype(np.float32)


def _flat(frames: np.ndarray) -> np.ndarray:
    return frames.reshape(len(frames), -1).astype(np.float32)


def fit_compression(frames: np.ndarray, count: int, seed: int = 0) -> Compression:
    """Compression from training clips.

    Args:
        frames: (N, T, 2, S, S).
        count: scores K; fewer where clips do not differ in so many directions.
        seed: of the choice of clips that set the directions.
    """
    some = np.sort(np.random.default_rng(seed).permutation(len(frames))[:CLIPS])
    flat = _flat(frames[some])
    mean = flat.mean(axis=0)
    flat -= mean
    count = min(count, len(flat) - 1)
    # the clips are fewer than their numbers: directions from the products of clips with clips
    last = len(flat) - 1
    squares, mixes = scipy.linalg.eigh((flat @ flat.T).astype(float), subset_by_index=(last - count + 1, last))
    squares, mixes = squares[::-1], mixes[:, ::-1]
    real = squares > LEAST**2 * squares[0]
    length, mixes = np.sqrt(squares[real]), mixes[:, real]
    components = flat.T @ (mixes / length).astype(np.float32)
    step = np.abs(components).max(axis=0) / 127.0
    spread = length / len(flat) ** 0.5 + 1e-9
    return Compression(mean=mean, components=np.rint(components / step), scale=step / np.sqrt(spread * spread.sum()))

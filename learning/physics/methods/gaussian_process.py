"""Gaussian process regression: scores of a clip -> parameters, exact, with one length for all scores.

    k(s, s') = v exp(-|s - s'|^2 / 2 l^2),      mean(s) = k(s, S) (k(S, S) + n I)^-1 y

Length l and noise n of each parameter maximise the likelihood of a part of the training clips; the scale v follows in
closed form.  A parameter that the clip does not show gets a large n and is answered by its mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

SUBSET = 800  # clips that choose length and noise: the cost grows with the cube
LENGTHS = np.geomspace(0.3, 8.0, 8)
NOISES = np.geomspace(1e-6, 1.0, 10)


@dataclass(frozen=True, kw_only=True)
class GaussianProcess:
    """Posterior mean.

    Attributes:
        inputs: (N, K) scores of the training clips.
        weights: (N, P) (k + n I)^-1 y, times the spread of each parameter.
        lengths: (P,) l.
        centre: (P,) means of the parameters.
    """

    inputs: np.ndarray
    weights: np.ndarray
    lengths: np.ndarray
    centre: np.ndarray

    def distance(self, scores: np.ndarray) -> np.ndarray:
        """(N,) of scores (N, K) to the nearest training clip."""
        return np.sqrt(squared_distances(scores, self.inputs).min(axis=1))

    def __call__(self, scores: np.ndarray) -> np.ndarray:
        """(N, K) -> (N, P)."""
        squares = squared_distances(scores, self.inputs)
        out = np.tile(self.centre, (len(scores), 1))
        for length in np.unique(self.lengths):  # parameters of one length share the kernel
            same = self.lengths == length
            out[:, same] += np.exp(-0.5 / length**2 * squares) @ self.weights[:, same]
        return out


def squared_distances(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """(N, K), (M, K) -> (N, M)."""
    products = some @ others.T
    return np.maximum((some**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2.0 * products, 0.0)


def fit_gaussian_process(inputs: np.ndarray, wanted: np.ndarray, seed: int) -> GaussianProcess:
    """Process from training scores (N, K) and what to say of them (N, P)."""
    inputs = inputs.astype(np.float32).astype(float)  # as they are kept
    some = np.random.default_rng(seed).permutation(len(inputs))[:SUBSET]
    centre, spread = wanted.mean(axis=0), wanted.std(axis=0, ddof=1) + 1e-9
    wanted = (wanted - centre) / spread
    chosen = choose(squared_distances(inputs[some], inputs[some]), wanted[some])
    squares = squared_distances(inputs, inputs)
    weights = np.empty_like(wanted)
    for length, noise in set(chosen):
        same = [p for p, one in enumerate(chosen) if one == (length, noise)]
        kernel = np.exp(-0.5 / length**2 * squares)
        kernel[np.diag_indices_from(kernel)] += noise
        weights[:, same] = scipy.linalg.solve(kernel, wanted[:, same], assume_a="pos", overwrite_a=True)
    return GaussianProcess(
        inputs=inputs, weights=weights * spread, centre=centre, lengths=np.array([length for length, _ in chosen])
    )


def choose(squares: np.ndarray, wanted: np.ndarray) -> list[tuple[float, float]]:
    """Length and noise (relative to v) of each parameter with the highest likelihood on a grid.

    Args:
        squares: (N, N) squared distances.
        wanted: (N, P) targets with mean zero.
    """
    best = [(np.inf, 1.0, 1.0)] * wanted.shape[1]
    for length in LENGTHS:
        # one eigendecomposition serves every noise and parameter
        values, vectors = scipy.linalg.eigh(np.exp(-0.5 / length**2 * squares), driver="evd")
        turned = (vectors.T @ wanted) ** 2
        for noise in NOISES:
            total = np.maximum(values, 0.0)[:, None] + noise
            scale = (turned / total).mean(axis=0)  # v, in closed form
            loss = 0.5 * len(squares) * np.log(scale + 1e-300) + 0.5 * np.log(total).sum()
            best = [min(b, (float(x), float(length), float(noise))) for b, x in zip(best, loss, strict=True)]
    return [(length, noise) for _, length, noise in best]

"""Correct a blunt estimator for one gown by learning, from simulations of that gown, how it deviates.

An estimator f(scores) that learned from gowns of many cuts is off for each of them in its own way.  Simulations of the
gown in question, of known parameters, say how: the deviation theta - f(scores) is a Gaussian process of the scores,
and what it says at the clip seen is where the next simulation is made.  The first simulations are moved aside, one
unknown after the other, so that the deviation is known in all directions.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .gaussian_process import squared_distances

ASIDE = 0.1  # move of the first simulations that differ in one unknown, in [0, 1]
NEARBY = 0.06  # the same of later ones
STILL = 0.006  # a guess so near to a simulation made says that something else has to be tried
REACH = 0.25  # longest step away from the best simulation
NOISE = 1e-5  # of the deviation, over its spread

Scores = Callable[[np.ndarray], np.ndarray]
"""Simulate: unknowns (N, P) in [0, 1] -> scores (N, K)."""


def follow(
    simulated: Scores,
    estimator: Callable[[np.ndarray], np.ndarray],
    lengths: np.ndarray,
    seen: np.ndarray,
    simulations: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Unknowns whose simulated clips are nearest to those seen, of all that were simulated.

    Args:
        simulated: simulates N clips.
        estimator: scores (N, K) -> unknowns (N, P).
        lengths: (P,) over which the estimator's deviation changes, in scores.
        seen: (N, K) scores of the clips.
        simulations: of each clip.

    Returns:
        (N, P) unknowns, (N,) distance of the scores.
    """
    said = estimator(seen)
    n, p = said.shape
    unknowns, scores = np.empty((simulations, n, p)), np.empty((simulations, *seen.shape))
    off = np.empty((simulations, n))
    aside = np.zeros(n, int)  # times that each clip was moved aside
    for done in range(simulations):
        for k in range(n):
            made, like = unknowns[:done, k], scores[:done, k]
            best = made[off[:done, k].argmin()] if done else said[k]
            if 2 <= done < 2 + p:
                unknowns[done, k] = _moved(made[1], done - 2, ASIDE)
                continue
            guess = said[k] + (_deviation(like, made - estimator(like), lengths, seen[k]) if done else 0.0)
            guess = np.clip(best + np.clip(guess - best, -REACH, REACH), 0.0, 1.0)
            if done > p and np.abs(made - guess).max(axis=1).min() < STILL:
                guess = _moved(best, aside[k] % p, NEARBY)
                aside[k] += 1
            unknowns[done, k] = guess
        scores[done] = simulated(unknowns[done])
        off[done] = np.linalg.norm(scores[done] - seen, axis=1)
    least = off.argmin(axis=0), np.arange(n)
    return unknowns[least], off[least]


def _moved(unknowns: np.ndarray, which: int, by: float) -> np.ndarray:
    """One unknown moved, away from the nearer end."""
    moved = unknowns.copy()
    moved[which] += by if moved[which] < 0.5 else -by
    return moved


def _deviation(scores: np.ndarray, deviations: np.ndarray, lengths: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(P,) of the process at (K,) from simulations (M, K), (M, P)."""
    squares, away = squared_distances(scores, scores), squared_distances(seen[None], scores)[0]
    out = np.empty(len(lengths))
    for k, length in enumerate(lengths):
        kernel = np.exp(-0.5 / length**2 * squares) + NOISE * np.eye(len(scores))
        out[k] = np.exp(-0.5 / length**2 * away) @ np.linalg.solve(kernel, deviations[:, k])
    return out

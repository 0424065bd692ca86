"""Correct an estimator by simulating what it found (indirect inference: Gourieroux, Monfort and Renault, 1993).

An estimator a(clip) is biased here and there, but it is the same estimator for a simulated clip.  So the parameters
wanted are those whose simulated clip gets the same answer as the clip seen:

    a(film(theta)) = a(clip)

The slopes of the left side are first taken to be those of a perfect estimator, or measured by one simulation with each
parameter moved by what the estimator does not know; after that the steps themselves correct them (Broyden).  The
estimator reduces the clip to a few numbers that change
smoothly; pixels do not, and Gauss-Newton steps on them get stuck where a parameter shows little.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

STEP = (0.004, 0.12)  # bounds of the moves that measure slopes, in [0, 1]
REACH = 3.0  # longest step, in moves
RIDGE = 0.02  # keeps directions still that no answer depends on

Answers = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Simulate and estimate: parameters (N, P) -> answers a (N, P), misfit to the clip seen (N,)."""


def match(
    answers: Answers, wanted: np.ndarray, unsure: np.ndarray, rounds: int, *, measure_slopes: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Parameters that get the wanted answers; of all that were simulated, those with the smallest misfit are kept.

    Args:
        answers: simulates N clips and estimates them.
        wanted: (N, P) answers for the clips seen, where the search starts.
        unsure: (N, P) deviation of these.
        rounds: steps.
        measure_slopes: spend P simulations more on the first slopes.

    Returns:
        (N, P) parameters, (N,) misfit; each clip is simulated 1 + rounds times, P more with `measure_slopes`.
    """
    n, p = wanted.shape
    scale = np.clip(unsure, *STEP)
    here = np.clip(wanted, 0.0, 1.0)
    given, misfit = answers(here)
    best, least = here.copy(), misfit.copy()
    slopes = np.tile(np.eye(p), (n, 1, 1))  # of the answers in moves, by parameters in moves
    for k in range(p if measure_slopes else 0):
        move = np.where(here[:, k] + scale[:, k] <= 1.0, scale[:, k], -scale[:, k])
        aside = here.copy()
        aside[:, k] += move
        there, _ = answers(aside)
        slopes[:, :, k] = (there - given) / scale * (scale[:, k] / move)[:, None]
    for _ in range(rounds):
        missing = (wanted - given) / scale
        normal = slopes.transpose(0, 2, 1) @ slopes + RIDGE * np.eye(p)
        step = np.linalg.solve(normal, slopes.transpose(0, 2, 1) @ missing[..., None])[..., 0]
        after = np.clip(here + np.clip(step, -REACH, REACH) * scale, 0.0, 1.0)
        taken = (after - here) / scale
        there, misfit = answers(after)
        surprise = (there - given) / scale - np.einsum("nij,nj->ni", slopes, taken)
        slopes += surprise[:, :, None] * taken[:, None, :] / ((taken**2).sum(axis=1) + 1e-3)[:, None, None]
        here, given = after, there
        better = misfit < least
        best[better], least[better] = here[better], misfit[better]
    return best, least

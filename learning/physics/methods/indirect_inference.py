"""Correct an estimator by simulating what it found (indirect inference: Gourieroux, Monfort and Renault, 1993).

An estimator a(clip) is biased here and there, but it is the same estimator for a simulated clip.  So the parameters
wanted are those whose simulated clip gets the same answer as the clip seen:

    a(render_clip(theta)) = a(clip)

The slopes of the left side are first taken to be those of a perfect estimator, or measured, one unknown after the
other; after that the steps themselves correct them (Broyden).  The estimator reduces the clip to a few numbers that
change smoothly; pixels do not, and Gauss-Newton steps on them get stuck where a parameter shows little.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

STEP = (0.004, 0.12)  # bounds of the moves that measure slopes, in [0, 1]
REACH = 3.0  # longest step, in moves
RIDGE = 0.02  # keeps directions still that no answer depends on
ENOUGH = 0.02  # steps shorter than this, in moves, end the search

Answers = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Simulate and estimate: parameters (N, P) -> answers a (N, P), misfit to the clip seen (N,)."""


def match(
    answers: Answers,
    wanted: np.ndarray,
    unsure: np.ndarray,
    rounds: int,
    *,
    measure: Sequence[int] = (),
    low: float | np.ndarray = 0.0,
    high: float | np.ndarray = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Unknowns that get the wanted answers; of all that were simulated, those with the smallest misfit are kept.

    Args:
        answers: simulates N clips and estimates them.
        wanted: (N, P) answers for the clips seen, where the search starts.
        unsure: (N, P) deviation of these.
        rounds: steps at most; it ends early when no clip's step is worth a simulation.
        measure: unknowns whose first slopes are measured, at a simulation each.
        low: bound of the unknowns, one or (P,).
        high: the other.

    Returns:
        (N, P) unknowns, (N,) misfit; each clip is simulated 1 + rounds times, and once for each of `measure`.
    """
    n, p = wanted.shape
    scale = np.clip(unsure, *STEP)
    here = np.clip(wanted, low, high)
    given, misfit = answers(here)
    best, least = here.copy(), misfit.copy()
    slopes = np.tile(np.eye(p), (n, 1, 1))  # of the answers in moves, by unknowns in moves
    for k in measure:
        aside = here.copy()
        aside[:, k] += np.where(here[:, k] + scale[:, k] <= np.broadcast_to(high, p)[k], scale[:, k], -scale[:, k])
        there, _ = answers(aside)
        slopes[:, :, k] = (there - given) / scale * (scale[:, k] / (aside - here)[:, k])[:, None]
    for _ in range(rounds):
        missing = (wanted - given) / scale
        normal = slopes.transpose(0, 2, 1) @ slopes + RIDGE * np.eye(p)
        step = np.linalg.solve(normal, slopes.transpose(0, 2, 1) @ missing[..., None])[..., 0]
        after = np.clip(here + np.clip(step, -REACH, REACH) * scale, low, high)
        taken = (after - here) / scale
        if np.abs(taken).max() < ENOUGH:
            break
        there, misfit = answers(after)
        surprise = (there - given) / scale - np.einsum("nij,nj->ni", slopes, taken)
        slopes += surprise[:, :, None] * taken[:, None, :] / ((taken**2).sum(axis=1) + 1e-3)[:, None, None]
        here, given = after, there
        better = misfit < least
        best[better], least[better] = here[better], misfit[better]
    return best, least

"""Two hypotheses at once, at first order: what neither explains alone, and a third would rather stand for.

Where two effects act, the one that explains most alone may be neither of them: bending stiffness took half of what air
drag and a fabric that stiffens did together, and of the two alone one was fourth, the other not among the best four.
The simulations that screen single hypotheses are enough to screen them by twos.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from .candidates import Candidate, clash
from .screening import Probe, sized


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Two hypotheses, each at the size that it wants beside the other.

    Attributes:
        members: both.
        left: weighted sum of squares that they would leave.
    """

    members: tuple[Candidate, Candidate]
    left: float


def paired(probes: list[Probe], own: np.ndarray) -> list[Pair]:
    """All twos of hypotheses of different names, the best of each two names, those that leave least first.

    Instants, which have no size, are left out.

    Args:
        probes: of the hypotheses, on one recording.
        own: (rows, j) columns of the numbers of what acts already.
    """
    best: dict[tuple[str, str], tuple[float, Probe, Probe]] = {}
    for a, b, left in _all_twos(probes, own):
        names = (a.candidate.name, b.candidate.name)
        if left < best.get(names, (np.inf,))[0]:
            best[names] = (left, a, b)
    out = []
    for left, a, b in sorted(best.values(), key=lambda each: each[0]):
        one, _ = sized(a, np.concatenate([own, b.columns], axis=1), a.start)
        other, _ = sized(b, np.concatenate([own, a.columns], axis=1), b.start)
        if one is not None and other is not None:
            out.append(Pair(members=(one, other), left=left))
    return out


def _all_twos(probes: list[Probe], own: np.ndarray) -> Iterator[tuple[Probe, Probe, float]]:
    """Every two that can act together, and what they would leave beside `own`."""
    sizes = sorted((p for p in probes if not p.moment), key=lambda p: p.candidate.name)
    for a, b in combinations(sizes, 2):
        names = a.candidate.name, b.candidate.name
        if names[0] != names[1] and not clash(names[0], {names[1]}):
            X = np.concatenate([own, a.columns, b.columns], axis=1)
            theta = np.linalg.lstsq(X, a.start, rcond=1e-8)[0]
            yield a, b, float(np.sum((a.start - X @ theta) ** 2))

"""How sure the numbers of a fitted set of drops are: the colour of the noise is not known either.

A drop says little about how long its noise remembers, and a set fitted under the likeliest colour alone looks too sure.
So does one of which all drops are given the same colour: the numbers may hang on two drops, whose noise is slower than
that of the others.  Each drop's colour is drawn by its own restricted likelihood; every draw has its own estimate and
its own errors (Student's t, as the noise's size is fitted too), and an interval holds 95 % of what they say together.

Where size and mass are known, so is the lift of the air, which is too small to be named: an interval holds with it and
without it.  From 90 m up it changed drags by 0.3 %, five standard errors.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import stdtr

from .colour import Colour, restricted, volume_of
from .fit import Drop, DropFit, lifted

LEVEL = 0.95
DRAWS = 200
HALVINGS = 50


def intervals(
    fit: DropFit, colours: Sequence[Colour], drops: Sequence[Drop] = (), lift: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper ends of the 95 % intervals of effects and releases, (p,) each; infinite where nothing is known.

    Args:
        fit: of the drops.
        colours: of the noise, that are worth trying.
        drops: that were fitted, where a lift is known.
        lift: share of the weight that the air is known to carry, 0 where it is not.
    """
    size = np.linalg.norm(fit.jacobian, axis=0) + 1e-12
    parts = [_Part(*rows, n, colours) for n, rows in enumerate(_rows(fit, size))]
    rows, p = sum(part.rows for part in parts), len(size)
    rng, steps, errors = np.random.default_rng(0), np.zeros((DRAWS, p)), np.zeros((DRAWS, p))
    for k in range(DRAWS):
        drawn = [part.drawn(rng) for part in parts]
        gram, across = np.sum([d[0] for d in drawn], axis=0), np.sum([d[1] for d in drawn], axis=0)
        square = sum(d[2] for d in drawn)
        inverse = np.linalg.pinv(gram, rcond=1e-14, hermitian=True)
        steps[k] = inverse @ across / size
        noise = max(float(square - across @ inverse @ across), 0.0) / max(rows - p, 1)
        errors[k] = np.sqrt(noise * np.maximum(np.diag(inverse), 0.0)) / size
    x = np.concatenate([fit.theta, np.zeros(p - len(fit.theta))])
    low, high = (_quantile(q, x + steps, errors, max(rows - p, 1)) for q in (0.5 - LEVEL / 2.0, 0.5 + LEVEL / 2.0))
    if lift and "buoyancy" not in fit.names:
        change = lifted(fit, list(drops), lift)
        low, high = low + np.minimum(change, 0.0), high + np.maximum(change, 0.0)
    return low, high


def _rows(fit: DropFit, size: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Jacobian (T, p), its columns over `size`, and residual (T,) of each drop."""
    ends = np.cumsum([len(r) for r in fit.residuals])[:-1]
    return list(zip(np.split(fit.jacobian / size, ends), fit.residuals, strict=True))


class _Part:
    """What one drop says of the numbers under every colour, and how likely that colour is by this drop alone.

    Args:
        J: (T, p) its rows of the jacobian.
        r: (T,) what the fit leaves of it [m].
        n: its place among the drops.
        colours: of the noise.

    Attributes:
        rows: T.
    """

    def __init__(self, J: np.ndarray, r: np.ndarray, n: int, colours: Sequence[Colour]) -> None:
        self.rows = len(r)
        self._said: list[tuple[np.ndarray, np.ndarray, float]] = []
        support = []
        for colour in colours:
            white = colour.white[n]
            a, y = white @ J, white @ r
            self._said.append((a.T @ a, a.T @ y, float(y @ y)))
            support.append(restricted(y, a, volume_of(white)))
        weight = np.exp(np.array(support) - max(support))
        self._weight = weight / weight.sum()

    def drawn(self, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, float]:
        """Information (p, p), its product with the residual (p,), and the residual's square, under a drawn colour."""
        return self._said[rng.choice(len(self._said), p=self._weight)]


def _quantile(q: float, centre: np.ndarray, error: np.ndarray, freedom: int) -> np.ndarray:
    """Quantile of a mixture of Student's t, one column per number, by bisection."""
    low, high = (centre - 60.0 * error).min(axis=0), (centre + 60.0 * error).max(axis=0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = stdtr(freedom, (middle - centre) / (error + 1e-300)).mean(axis=0) < q
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)

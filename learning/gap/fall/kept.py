"""Which effects of a set would be named again: the bootstrap over stretches of the drops."""

from __future__ import annotations

import numpy as np

from .fit import DropFit
from .search import DropSearch, foreseen, price_of

STRETCHES = 6  # of each drop, resampled as blocks, as samples of one drop are not independent
RESAMPLED = 200


def kept(found: DropSearch, fit: DropFit, mass: float | None, diameter: float | None) -> dict[str, float]:
    """Part of resampled stretches in which each effect of a fit keeps paying its price.

    Args:
        found: the search.
        fit: whose effects.
        mass: of the body [kg], None where it is not known.
        diameter: of the body [m], None where it is not known.
    """
    rng = np.random.default_rng(0)
    out = {}
    for name in fit.names:
        rest = tuple(n for n in fit.names if n != name)
        without = found.refit(rest, fit.mode)
        table = np.array(
            [
                (a.sum(), b.sum())
                for x, y in zip(without.parts, fit.parts, strict=True)
                for a, b in zip(np.array_split(x, STRETCHES), np.array_split(y, STRETCHES), strict=True)
            ]
        )
        prices = [price_of(n, fit.mode, len(found.drops), found.price) for n in (fit.names, rest)]
        price = prices[0] - prices[1] - foreseen((name,), mass, diameter)
        wins = 0
        for _ in range(RESAMPLED):
            s = table[rng.integers(len(table), size=len(table))].sum(axis=0)
            wins += found.worth * np.log(s[0] / max(s[1], 1e-12)) > price
        out[name] = wins / RESAMPLED
    return out

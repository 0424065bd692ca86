"""The drop that tells two explanations apart, and the smallest drag that would have been seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from ....sim.effects.body.body_registry import BODY_EFFECTS
from ..findings import released, told_apart
from .drop import GRAVITY, height
from .fit import Drop, DropFit, fit_drops, table_of
from .search import EFFECT, FIRST, DropSearch

HEIGHTS = (0.25, 0.5, 1.0, 2.0, 4.0)  # over the highest release so far
HIGHEST = 100.0  # [m] a body can be dropped from
BALLAST = (1.0, 0.5, 3.0, 8.0)  # mass over that of the body as it is; less is a hollow copy


def separating(drops: list[Drop], fit: DropFit, other: tuple[str, DropFit], floor: float) -> str:
    """Height and mass at which two explanations part most, and by how much.

    Args:
        drops: the recorded drops.
        fit: the one explanation.
        other: what stands in for part of it, and the other explanation.
        floor: root mean square of the noise [m].
    """
    best = ("", 0.0)
    for top, mass in kinds(drops):
        duration = 2.5 * np.sqrt(2 * top / GRAVITY) + 1.0
        t = np.linspace(0.0, duration, 120)
        pair = []
        for f in (fit, other[1]):
            table, scale = table_of(f.values, duration + 1.0, mass)
            h, _ = height(t, table, 0.0, lateness(f))
            pair.append(scale * h)
        inside = np.minimum(*pair) > -top
        if inside.sum() > 10:
            gap = (pair[0] - pair[1])[inside]
            apart = float(np.sqrt(np.mean((gap - gap.mean()) ** 2)) / floor)
            if apart > best[1]:
                best = (released(top, mass), apart)
    return told_apart(best[0], " + ".join([*fit.names, *(["delay"] if fit.mode == "late" else [])]), other[0], best[1])


def kinds(drops: Sequence[Drop]) -> list[tuple[float, float]]:
    """Drops worth a thought: height of release [m], and mass over that of the body as it is."""
    top = max(float(d.h.max()) for d in drops)
    return list(dict.fromkeys((min(a * top, HIGHEST), f) for a, f in product(HEIGHTS, BALLAST)))


def lateness(fit: DropFit) -> float:
    """How long after its first sample every drop is released [s], 0 where the drops do not share it."""
    return float(fit.releases[:, 1].mean()) if fit.mode == "late" else 0.0


def detectable(found: DropSearch, base: DropFit) -> dict[str, str]:
    """Smallest drag these drops could have shown: put into the user's own residuals, then searched for.

    Args:
        found: the search.
        base: the explanation it ended with.
    """
    out = {}
    for name, unit in (("linear_drag", 0.05), ("quadratic_drag", 0.005)):
        if name in base.names or "wind" in base.names:
            continue
        names = (*base.names, name)
        values = np.concatenate([base.theta, [0.0]])
        for factor in (0.1, 0.2, 0.4, 0.8, 1.6, 3.2):
            given = np.concatenate([base.theta, [unit * factor]])
            drops = []
            for d in found.drops:
                shifted = fit_drops([d], names, base.mode if base.mode != "late" else "free", start=given)
                plain = fit_drops([d], names, shifted.mode, start=values)
                drops.append(replace(d, h=d.h + _between(shifted, plain, d)))
            with_it = fit_drops(drops, names, base.mode)
            without = fit_drops(drops, base.names, base.mode)
            price = found.price + EFFECT + (0.0 if base.names else FIRST)
            if found.worth * np.log(without.rss / max(with_it.rss, 1e-12)) > price:
                out[name] = f"{unit * factor:.3g} {BODY_EFFECTS[name].parameters[0].unit}"
                break
    return out


def _between(shifted: DropFit, plain: DropFit, drop: Drop) -> np.ndarray:
    """Height change an injected effect makes in one drop, release unchanged."""
    duration = float(drop.t[-1]) + 1.0
    release = plain.releases[0]
    with_it, scale = table_of(shifted.values, duration, drop.factor)
    without, _ = table_of(plain.values, duration, drop.factor)
    return scale * (height(drop.t, with_it, *release)[0] - height(drop.t, without, *release)[0])

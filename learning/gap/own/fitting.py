"""Values of a set of effects by least squares through the user's simulator, and a first set to start a search from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from .simulation import Simulation, Values
from .system import Effect

WIDE = (0.3, 1.0, 3.0)  # typical sizes tried before a fit, as a simulator may be far from linear
INSIDE = 0.1  # typical sizes from a bound to start at: the solver creeps away from where it may not go
SCREENED = 5  # simulations that a first look at an effect is worth
MOST = 3  # effects in the first set; the search adds what more there is
WORTH = 0.03  # part of what is left that an effect of the first set must explain


@dataclass(frozen=True, kw_only=True)
class Fit:
    """Values at which a set of effects fits best.

    Attributes:
        effects: the set.
        values: every parameter of the system, 0 where its effect is absent.
        rss: (R, C) squares left in each recording and channel, in squared scales.
    """

    effects: tuple[Effect, ...]
    values: Values
    rss: np.ndarray

    def score(self, rows: np.ndarray) -> float:
        """Sum over recordings (R,) of rows and over channels of n log(rss): one that is far off counts as one."""
        return float(rows @ np.sum(np.log(self.rss + 1e-30), axis=1))


def rows_of(sim: Simulation) -> np.ndarray:
    """Rows compared of each recording, (R,)."""
    return np.array([len(r.measured) for r in sim.recordings])


def squares(sim: Simulation, values: Values, scale: np.ndarray) -> np.ndarray:
    """Squares left in each recording and channel over the scale's, (R, C)."""
    return np.array([np.sum((sim.left(r, values) / scale) ** 2, axis=0) for r in sim.recordings])


def fit(sim: Simulation, effects: Sequence[Effect], start: Values, scale: np.ndarray, most: int = 30) -> Fit:
    """Fit the parameters of some effects together, within their bounds.

    A recording in which the start is far from what was measured says little of where to go, and counts no more than
    the usual one.

    Args:
        sim: the system on the recordings to fit.
        effects: the set.
        start: values to start from; those of other effects do not count.
        scale: (C,) by which the channels are weighed.
        most: simulations of all recordings, derivatives not counted.
    """
    parameters = [p for e in effects for p in e.parameters]
    if not parameters:
        return Fit(effects=(), values=sim.none, rss=squares(sim, sim.none, scale))
    unit = np.array([p.typical for p in parameters])

    def at(x: np.ndarray) -> Values:
        bounded = (float(np.clip(v, p.lower, p.upper)) for v, p in zip(x * unit, parameters, strict=True))
        return {**sim.none, **{p.name: v for p, v in zip(parameters, bounded, strict=True)}}

    def residual(x: np.ndarray) -> np.ndarray:
        parts = zip(sim.recordings, weights, strict=True)
        return np.concatenate([w * (sim.left(r, at(x)) / scale).ravel() for r, w in parts])

    def slope(x: np.ndarray) -> np.ndarray:
        rows = [
            w * np.concatenate([sim.tangent(r, at(x), e) for e in effects], axis=2) / scale[:, None]
            for r, w in zip(sim.recordings, weights, strict=True)
        ]
        return -np.concatenate([X.reshape(-1, len(parameters)) for X in rows]) * unit

    begun = {**sim.none, **{p.name: start[p.name] for p in parameters}}
    sizes = np.sqrt(squares(sim, begun, scale).sum(axis=1) / rows_of(sim))
    weights = np.minimum(1.0, np.median(sizes) / (sizes + 1e-30))
    low, high = (np.array([getattr(p, end) for p in parameters]) / unit for end in ("lower", "upper"))
    x0 = np.array([start[p.name] for p in parameters]) / unit
    x0 = np.clip(x0, low + np.minimum(INSIDE, 0.5 * (high - low)), high - np.minimum(INSIDE, 0.5 * (high - low)))
    found = least_squares(
        residual,
        x0,
        jac=slope,  # pyright: ignore[reportArgumentType] - its annotation knows no callable
        bounds=(low, high),
        max_nfev=most,
        xtol=1e-6,
        ftol=1e-9,
    )
    x = np.where(np.abs(found.x) < 1e-6, 0.0, found.x)  # the solver stays a hair inside its bounds
    return Fit(effects=tuple(effects), values=at(x), rss=squares(sim, at(x), scale))


def best_start(sim: Simulation, base: Values, effect: Effect, scale: np.ndarray) -> Values:
    """Of a few sizes of an effect beside others, 0 among them, the one that leaves least.

    Every recording has the numbers of its own that suit it without the effect, or none: it is a start, no more.
    """
    tried, own = [base], [(sim.own(r, base), None) for r in sim.recordings]
    for factor in WIDE:
        for sign in (1.0, -1.0):
            new = {p.name: _inside(sign * factor * p.typical, p.lower, p.upper) for p in effect.parameters}
            if any(new.values()):
                tried.append({**base, **new})

    def left(values: Values) -> float:
        total = 0.0
        for r, either in zip(sim.recordings, own, strict=True):
            parts = [np.sum(((r.measured - sim.raw(r, values, o)) / scale) ** 2, axis=0) for o in either]
            total += len(r.measured) * float(np.sum(np.log(min(parts, key=np.sum) + 1e-30)))
        return total

    return min(tried, key=left)


def _inside(x: float, low: float, high: float) -> float:
    return min(max(x, low), high)


def joined(sim: Simulation, now: Fit, effect: Effect, scale: np.ndarray) -> Fit:
    """A fit with one effect more."""
    start = now.values if effect.regressor else best_start(sim, now.values, effect, scale)
    return fit(sim, (*now.effects, effect), start, scale, SCREENED)


def first_set(sim: Simulation) -> Fit:
    """A set to start the search from, built up one by one through the simulator.

    The search works with derivatives.  Where the model as given is far from the recording these say little, so the
    search begins nearby.  Where every effect is linear there is no need.
    """
    now = fit(sim, (), sim.none, sim.scale)
    if all(e.regressor for e in sim.system.effects):
        return now
    rows = rows_of(sim)
    for _ in range(MOST):
        free = [e for e in sim.system.effects if e.key not in {k.key for k in now.effects}]
        tried = [joined(sim, now, e, sim.scale) for e in free]
        best = min(tried, key=lambda f: f.score(rows), default=now)
        if best.score(rows) > now.score(rows) + rows.sum() * np.log(1.0 - WORTH):
            break
        now = best
    return now

"""Effects of a user's system that fit as well as a named one, and the recording that would tell."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ..joints.alternatives import SAME, alternatives
from .fitting import best_start, fit, rows_of, squares
from .naming import Found
from .simulation import Recording, Simulation, Values
from .system import Columns, Effect

FITS = 8  # simulations that tell whether an effect can stand in for another


@dataclass(frozen=True, kw_only=True)
class Equal:
    """Another explanation that fits as well.

    Attributes:
        names: effects that stand in for the one.
        values: every parameter of the system under the other explanation.
    """

    names: tuple[str, ...]
    values: Values


def equals(sim: Simulation, found: Found, k: int) -> list[Equal]:
    """What could stand in for the `k`-th named effect, best first.

    The search says which come nearest, by its columns; a simulator is only nearly linear, so each of these is fitted by
    simulation beside the other effects, and kept if that leaves no noticeably more.
    """
    search, chosen, noise = found.named.search, found.named.chosen, found.named.noise.rms
    by_key = {e.key: e for e in sim.system.effects}
    rest = tuple(e for i, e in enumerate(found.effects) if i != k)
    base = _score(sim, found.point.values, noise)
    out: list[tuple[float, Equal]] = []
    for other in alternatives(search, chosen, chosen[k], np.inf):
        new = tuple(by_key[b.key] for b in other.blocks)
        start = _start(sim, found.point.values, found.effects[k], new, noise)
        values = fit(sim, (*rest, *new), start, noise, FITS).values
        worse = _score(sim, values, noise) - base
        if worse < SAME * max(float(search.widening[chosen[k]]), 1.0):
            out.append((worse, Equal(names=other.names, values=values)))
    return [e for _, e in sorted(out, key=lambda pair: pair[0])]


def _score(sim: Simulation, values: Values, noise: np.ndarray) -> float:
    return rows_of(sim).sum() * float(np.sum(np.log(squares(sim, values, noise).sum(axis=0) + 1e-30)))


def _start(sim: Simulation, values: Values, old: Effect, new: tuple[Effect, ...], noise: np.ndarray) -> Values:
    start = {**values, **dict.fromkeys((p.name for p in old.parameters), 0.0)}
    for e in new:
        start = best_start(sim, start, e, noise)
    return start


def separating(sim: Simulation, found: Found, other: Equal, floor: np.ndarray) -> tuple[str, float]:
    """The recording in which two explanations part most.

    Returns:
        (sentence, difference of their predictions over the noise floor); ("", 0) where the class offers none.
    """
    best = ("", 0.0)
    r = sim.recordings[0]
    for sentence, columns in sim.system.experiments(r.columns).items():
        planned = _planned(r, sentence, columns)
        own = sim.own(r, found.point.values)
        apart = sim.raw(planned, found.point.values, own) - sim.raw(planned, other.values, own)
        size = float(np.sqrt(np.mean((apart / floor) ** 2)))
        if size > best[1]:
            best = (sentence, size)
    return best


def _planned(r: Recording, name: str, columns: Columns) -> Recording:
    rows = len(columns["t"])
    measured = np.zeros((len(range(*r.pick.indices(rows))), r.measured.shape[1]))
    episode = replace(r.episode, name=f"{r.episode.name}: {name}")
    return Recording(episode=episode, columns=MappingProxyType(dict(columns)), measured=measured, pick=r.pick)

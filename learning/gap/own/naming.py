"""From recordings of a user's system to the set of effects: search near a fit, fit by simulation, search again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import GapError
from ..joints.bootstrap import confident
from ..joints.gram import assemble
from ..joints.noise import NoiseModel, estimate_noise
from ..joints.search import Search
from ..joints.workflow import Named, first_noise
from .fitting import Fit, best_start, first_set, fit, rows_of, squares
from .model_error import deviations, faintest, least_sure
from .simulation import Simulation
from .system import Effect
from .working_point import WorkingPoint

ROUNDS = 5


@dataclass(frozen=True, kw_only=True)
class Found:
    """What the search found.

    Attributes:
        named: as the search of joints gives it; its `theta` are values fitted by simulation.
        point: the working point it ended at.
        effects: the user's effects, in the order of `named.blocks`.
    """

    named: Named
    point: WorkingPoint
    effects: tuple[Effect, ...]


def name_own(sim: Simulation) -> Found:
    """Search, fit by simulation and search again until the set stands still.

    Raises:
        GapError: no effect changes any prediction.
    """
    now = first_set(sim)
    seen: list[frozenset] = []
    noise: NoiseModel | None = None
    point, search = WorkingPoint(sim, now.values), None
    if not point.blocks:
        raise GapError(f"{type(sim.system).__name__}: none of its effects changes what predict returns")
    for _ in range(ROUNDS):
        if noise is None or noise.source == "residual":
            noise = _noise(sim, point, now, first=search is None)
        search = Search(gram=assemble(point.blocks, point.logs), noise=noise)
        chosen = search.run(_indices(point, now.effects))
        keys = frozenset(search.blocks[i].key for i in chosen)
        if keys in seen:
            break
        seen.append(keys)
        now, point = _moved(sim, search, chosen, noise, now)
    assert noise is not None
    named = _named(point, now, noise)
    sure = confident(named, point.logs)
    if len(sure.chosen) < len(named.chosen):
        now, point = _moved(sim, named.search, sure.chosen, noise, now)
        named = _named(point, now, _noise(sim, point, now, first=False) if noise.source == "residual" else noise)
    while named.chosen:
        sd = deviations(named.blocks, named.search.weight, point.logs, sim.model_error)
        if (doubtful := least_sure(named.blocks, named.theta, sd)) is None:
            doubtful = faintest(named.blocks, named.theta, point.logs, sim.model_error)
        if doubtful is None:
            break
        chosen = named.chosen[:doubtful] + named.chosen[doubtful + 1 :]
        now, point = _moved(sim, named.search, chosen, noise, now)
        named = _named(point, now, _noise(sim, point, now, first=False) if noise.source == "residual" else noise)
    return Found(named=named, point=point, effects=now.effects)


def none_of(found: Found, sim: Simulation) -> Found:
    """The same question answered with no effect, where what was found does not hold."""
    point = WorkingPoint(sim, sim.none)
    now = Fit(effects=(), values=sim.none, rss=np.ones((1, 1)))
    return Found(named=_named(point, now, found.named.noise), point=point, effects=())


def without(found: Found, sim: Simulation, k: int) -> Found:
    """The set without its `k`-th effect, fitted by simulation again."""
    chosen = found.named.chosen[:k] + found.named.chosen[k + 1 :]
    before = Fit(effects=found.effects, values=found.point.values, rss=np.ones((1, 1)))
    noise = found.named.noise
    now, point = _moved(sim, found.named.search, chosen, noise, before)
    return Found(named=_named(point, now, noise), point=point, effects=now.effects)


def _moved(
    sim: Simulation, search: Search, chosen: tuple[int, ...], noise: NoiseModel, before: Fit
) -> tuple[Fit, WorkingPoint]:
    """The set fitted by simulation, from where the search puts it or from where it was, and the working point there."""
    by_key = {e.key: e for e in sim.system.effects}
    effects = tuple(by_key[search.blocks[i].key] for i in chosen)
    names = [p.name for e in effects for p in e.parameters]
    straight = {**sim.none, **dict(zip(names, (float(x) for x in search.fit(chosen)), strict=True))}
    kept = {**sim.none, **{name: before.values[name] for name in names}}
    for e in effects:
        if e.key not in {k.key for k in before.effects}:
            kept = best_start(sim, kept, e, noise.rms)
    rows = rows_of(sim)
    start = min((straight, kept), key=lambda v: rows @ np.sum(np.log(squares(sim, v, noise.rms) + 1e-30), axis=1))
    now = fit(sim, effects, start, noise.rms)
    return now, WorkingPoint(sim, now.values)


def _noise(sim: Simulation, point: WorkingPoint, now: Fit, first: bool) -> NoiseModel:
    if first:
        return first_noise(point.blocks, point.logs)
    return estimate_noise([sim.left(r, now.values) for r in sim.recordings], "residual")


def _indices(point: WorkingPoint, effects: tuple[Effect, ...]) -> tuple[int, ...]:
    at = {b.key: i for i, b in enumerate(point.blocks)}
    return tuple(at[e.key] for e in effects if e.key in at)


def _named(point: WorkingPoint, now: Fit, noise: NoiseModel) -> Named:
    search = Search(gram=assemble(point.blocks, point.logs), noise=noise)
    chosen = _indices(point, now.effects)
    theta = np.array([now.values[p.name] for i in chosen for p in search.blocks[i].parameters])
    blocks = tuple(search.blocks[i] for i in chosen)
    return Named(blocks=blocks, theta=theta, noise=noise, search=search, chosen=chosen)

"""Other sets of effects that explain a cloth as well as the named one, worked out at its solution.

Every member of the final set is left out, and exchanged for the hypotheses that are likeliest in its place; they are
fitted by simulation.  What then fits the fitted recordings about as well is an equal; so is what fits them somewhat
worse, but no worse than the named one on the recordings held out: of many hypotheses the best on some recordings is in
part luck, which is gone on others.  What would gain more beside the final set than noise does is told, too.

A number that several of these sets have is as sure as they are together: its interval reaches from the lowest end of
theirs to the highest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from .candidates import Candidate, candidates, clash
from .exchange import SAME, Exchange, Other
from .fitting import ClothFitter, Free
from .polish import rested, steps_of, sure
from .scene import ClothEpisode, ClothScene
from .screening import probe, sized
from .search import NUMBER, ClothSearch
from .simulate import Simulator

LEVEL = 0.05  # chance that noise alone makes the held-out recordings prefer the right one of two sets by as little
DECISIVE = 3.0  # what the fitted recordings have against a set, over the price of what it lacks, that settles it
MOST = 4
MOST_BESIDE = 3
MOST_SETS = 6

Names = tuple[tuple[str, str], ...]  # effects and their targets


@dataclass(frozen=True, kw_only=True)
class Equals:
    """What cannot be told from the named set.

    Attributes:
        instead: per chosen name, others that could stand in for it, best first.
        sets: whole sets, those in which one member was exchanged first.
        spread: per number of the named set, the lowest and the highest end of its intervals in those sets.
    """

    instead: dict[str, tuple[str, ...]]
    sets: tuple[Names, ...]
    spread: dict[Free, tuple[float, float]]


def equals(
    sim: Simulator, scene: ClothScene, fitted: list[ClothEpisode], heldout: list[ClothEpisode], found: ClothSearch
) -> Equals:
    """Exchange every member of the final set, leave it out, and join others.

    Args:
        sim: runs the scene.
        scene: the cloth.
        fitted: recordings the set was chosen on.
        heldout: those it was not.
        found: the search's result.
    """
    fitter = ClothFitter(sim, fitted, found.weights)
    named = Other(chosen=found.chosen, fit=found.fit)
    around = Exchange(fitter=fitter, scene=scene, named=named, worth=found.worth)
    judge = _Judge(around, ClothFitter(sim, heldout, found.weights))
    instead, exchanged, fewer = dict[str, tuple[str, ...]](), list[Other](), list[Other]()
    for member in found.chosen:
        alike = sorted((o for o in around.instead(member) if judge.open(o, member)), key=around.worse)
        instead[member.name] = tuple(_called(o.chosen[-1], member) for o in alike[:MOST])
        exchanged += alike
        without = around.without(member)
        if not member.recalibration and _names(without) and judge.open(without, member):
            fewer.append(without)
    more = _beside(around)
    told = [*sorted(exchanged, key=around.worse), *fewer, *more]
    sets = dict.fromkeys(_names(o) for o in told)
    sets = [s for s in sets if s and set(s) != set(_names(named))]
    return Equals(instead=instead, sets=tuple(sets[:MOST_SETS]), spread=_spread(fitter, found, told))


def _names(of: Other) -> Names:
    return tuple((c.name, c.target) for c in of.chosen if not c.recalibration)


def _called(c: Candidate, member: Candidate) -> str:
    """What stands in for a member, with its target where that is another."""
    return c.name if c.target == member.target else f"{c.name} of {c.target}"


class _Judge:
    """Whether another set may be right."""

    def __init__(self, around: Exchange, apart: ClothFitter) -> None:
        self._around, self._apart = around, apart

    def open(self, other: Other, member: Candidate) -> bool:
        """Whether a set without a member fits as well as the named one, or does so on other recordings."""
        worse = self._around.worse(other)
        if worse < SAME:
            return True
        if worse > DECISIVE * NUMBER * len(member.start.free) or not self._apart.episodes:
            return False
        models = (self._around.named.fit.model, other.fit.model)
        before, after = (self._apart.rss(self._apart.residuals(m)) for m in models)
        rows, fitted = (sum(x.size for x in f.data) for f in (self._apart, self._around.fitter))
        return self._around.worth * rows / fitted * np.log(after / before) < float(chi2.isf(LEVEL, 1))


def _beside(around: Exchange) -> list[Other]:
    """The final set and one more, where that gains more than noise would over all names tried; best first.

    At first order on the recording that the named set leaves most of, then by simulation on all.
    """
    fit, every = around.named.fit, around.fitter
    worst = int(np.argmax([np.mean((r * every.weights) ** 2) for r in fit.residuals]))
    alone = ClothFitter(every.sim, [every.episodes[worst]], every.weights)
    taken = {c.name for c in around.named.chosen}
    pool = candidates(around.scene, every.episodes, every.with_bodies(fit.model))
    pool = [c for c in pool if not c.recalibration and c.name not in taken and not clash(c.name, taken)]
    left, rows = [fit.residuals[worst]], fit.residuals[worst].size
    own = alone.columns(fit.model, left, steps_of(around.named.chosen))
    worth = around.worth * rows / sum(r.size for r in fit.residuals)
    best, names = dict[str, tuple[float, Candidate]](), {c.name for c in pool}

    def by_chance(c: Candidate) -> float:
        return float(chi2.isf(LEVEL / len(names), len(c.start.free)))

    for p in probe(alone, fit.model, pool, float(np.sqrt(alone.rss(left)))):
        c, with_it = sized(p, own, p.start)
        if c is None or p.moment:
            continue
        without = p.start - own @ np.linalg.lstsq(own, p.start, rcond=1e-8)[0]
        gained = worth * float(np.log((without @ without + 1e-30) / (with_it + 1e-30))) - by_chance(c)
        if gained > best.get(c.name, (0.0,))[0]:
            best[c.name] = (gained, c)
    likely = [c for _, c in sorted(best.values(), key=lambda pair: -pair[0])][:MOST_BESIDE]
    joined = ((c, around.joined(c)) for c in likely)
    return sorted((o for c, o in joined if around.worse(o) < -by_chance(c)), key=around.worse)


def _spread(fitter: ClothFitter, found: ClothSearch, told: list[Other]) -> dict[Free, tuple[float, float]]:
    """Lowest and highest end of the intervals that the numbers of the named set have in others."""
    ends: dict[Free, list[float]] = {}
    for other in told:
        known = sure(fitter, rested(fitter, other.fit, other.chosen, found.worth), other.chosen)
        for which, half in zip(known.model.free, known.half, strict=True):
            if which in found.sure.model.free and np.isfinite(half):
                x = known.model.value(which)
                ends.setdefault(which, []).extend((x - float(half), x + float(half)))
    return {which: (min(x), max(x)) for which, x in ends.items()}

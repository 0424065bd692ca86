"""Other sets of effects that explain a cloth as well as the named one, from the columns and the noise at its solution.

The search compares a few hypotheses as it goes, before what is found later is there and before a place or an instant is
looked for.  Here every hypothesis is simulated once beside the final set, which gives the columns it would add there.
With them each member of the set is left out, and exchanged for each hypothesis; what comes near is simulated and
fitted.  What then fits the fitted recordings about as well is an equal; so is what fits them somewhat worse, but no
worse than the named one on the recordings held out: of many hypotheses the best on some recordings is in part luck,
which is gone on others.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from .candidates import Candidate, candidates
from .fitting import ClothFit, ClothFitter, ClothModel
from .scene import ClothEpisode, ClothScene
from .search import NUMBER, SAME, ClothSearch, begun, clash, polish, settled, steps_of
from .simulate import Simulator

LEVEL = 0.05  # chance that noise alone makes the held-out recordings prefer the right one of two sets by as little
DECISIVE = 3.0  # what the fitted recordings have against a set, over the price of what it lacks, that settles it
HOPELESS = 5.0  # screened so many times farther off than equals may be, a hypothesis is not fitted
SEARCHED = 3.0  # so many times farther off, its place or its instant is looked for
SOUGHT = frozenset({"added_mass", "snag", "grip_slip", "strain_stiffening"})  # of which screening fixes something
MOST = 4
MOST_BESIDE = 3

Names = tuple[tuple[str, str], ...]  # effects and their targets


@dataclass(frozen=True, kw_only=True)
class Equals:
    """What cannot be told from the named set.

    Attributes:
        instead: per chosen name, others that could stand in for it, best first.
        sets: whole sets with fewer effects, and with one more.
    """

    instead: dict[str, tuple[str, ...]]
    sets: tuple[Names, ...]


def equals(
    sim: Simulator, scene: ClothScene, fitted: list[ClothEpisode], heldout: list[ClothEpisode], found: ClothSearch
) -> Equals:
    """Exchange every member of the final set, and leave it out.

    Args:
        sim: runs the scene.
        scene: the cloth.
        fitted: recordings the set was chosen on.
        heldout: those it was not.
        found: the search's result.
    """
    near = _Columns(sim, scene, fitted, found)
    tried = _Fitted(sim, scene, fitted, heldout, found)
    instead, sets = dict[str, tuple[str, ...]](), list[Names]()
    for member in found.chosen:
        rest = [c for c in found.chosen if c is not member]
        plain = tuple((c.name, c.target) for c in rest if not c.recalibration)
        near_without = plain and not member.recalibration and near.left_out(member) < HOPELESS * SAME
        if near_without and tried.open(tried.fit(member, rest), member):
            sets.append(plain)
        alike = []
        for off, c in near.exchanged(member):
            fit = tried.fit(member, rest, c, sought=off < SEARCHED * SAME)
            if tried.open(fit, member):
                alike.append((tried.worse(fit), c.name))
        instead[member.name] = tuple(name for _, name in sorted(alike)[:MOST])
    named = tuple((c.name, c.target) for c in found.chosen if not c.recalibration)
    sets += [(*named, (c.name, c.target)) for c in near.beside()]
    return Equals(instead=instead, sets=tuple(sets))


class _Columns:
    """What each hypothesis would add to the final set, on the recording that the model as given misses most."""

    def __init__(self, sim: Simulator, scene: ClothScene, fitted: list[ClothEpisode], found: ClothSearch) -> None:
        self._found, model = found, found.fit.model
        worst = int(np.argmax([np.mean((r * found.weights) ** 2) for r in found.plain.residuals]))
        self._fitter = ClothFitter(sim, [fitted[worst]], found.weights)
        self._worth = found.worth * found.fit.residuals[worst].size / sum(r.size for r in found.fit.residuals)
        self._named = self._fitter.rss([found.fit.residuals[worst]]) + 1e-30
        taken = {c.name for c in found.chosen}
        bodies = ClothFitter(sim, fitted, found.weights).residuals(replace(model, carried=True))
        self._pool = [c for c in candidates(scene, fitted, bodies) if c.name not in taken]
        pushed = [model.joined(c.start.moved({f: c.push.value(f)})) for c in self._pool for f in c.start.free]
        sim.ahead([(fitted[worst], m.acting, m.physics) for m in pushed])
        self._own = self._fitter.columns(model, self._seen(model), steps_of(list(found.chosen))) if model.free else None
        self._theirs = [None if c.name == "grip_slip" else self._of(c) for c in self._pool]

    def left_out(self, member: Candidate) -> float:
        """By how much the rest of the set fits worse, at first order."""
        return self._off(self._without(member), self._rest(member))

    def exchanged(self, member: Candidate) -> Iterator[tuple[float, Candidate]]:
        """Hypotheses at the size they would have in a member's place, and by how much they fit worse at first order.

        One of each name, near ones alone, the nearest first.
        """
        others, start, best = {c.name for c in self._found.chosen if c is not member}, self._without(member), {}
        for c, columns in zip(self._pool, self._theirs, strict=True):
            if clash(c.name, others):
                continue
            if columns is None:  # a moment, not a size: the simulation itself is the answer
                tried = self._found.fit.model.without(member.name).joined(c.push)
                off, sized = self._off(self._fitter.flat(self._seen(tried)), self._rest(member)), c
            else:
                off, sized = self._sized(c, start, columns, self._rest(member))
            if sized is not None and off < min(HOPELESS * SAME, best.get(c.name, (np.inf,))[0]):
                best[c.name] = (off, sized)
        yield from sorted(best.values(), key=lambda pair: pair[0])

    def beside(self) -> list[Candidate]:
        """What gains more beside the final set, at first order, than noise would over all names tried; best first."""
        named = self._fitter.flat(self._seen(self._found.fit.model))
        own = np.zeros((len(named), 0)) if self._own is None else self._own
        base, best, names = self._off(named, own), dict[str, tuple[float, Candidate]](), {c.name for c in self._pool}
        for c, columns in zip(self._pool, self._theirs, strict=True):
            if columns is None or c.recalibration or clash(c.name, {x.name for x in self._found.chosen}):
                continue
            gained = base - self._off(named, np.concatenate([own, columns], axis=1))
            gained -= float(chi2.isf(LEVEL / len(names), len(c.start.free)))
            if gained > best.get(c.name, (0.0,))[0]:
                best[c.name] = (gained, c)
        return [c for _, c in sorted(best.values(), key=lambda pair: -pair[0])][:MOST_BESIDE]

    def _seen(self, model: ClothModel) -> list[np.ndarray]:
        return self._fitter.residuals(model)

    def _of(self, c: Candidate) -> np.ndarray:
        """Weighted change of the prediction by each of a candidate's numbers at the size it is pushed to, (rows, k)."""
        base = self._found.fit.model.joined(c.start)
        start = self._fitter.flat(self._seen(base))
        pushed = [self._fitter.flat(self._seen(base.moved({f: c.push.value(f)}))) for f in c.start.free]
        return np.stack([start - x for x in pushed], axis=1)

    def _without(self, member: Candidate) -> np.ndarray:
        return self._fitter.flat(self._seen(self._found.fit.model.without(member.name)))

    def _rest(self, member: Candidate) -> np.ndarray:
        """Columns of the numbers of the other members, (rows, k)."""
        keep = [k for k, f in enumerate(self._found.fit.model.free) if member.name not in f]
        return np.zeros((len(self._without(member)), 0)) if self._own is None else self._own[:, keep]

    def _off(self, start: np.ndarray, columns: np.ndarray) -> float:
        left = start - columns @ np.linalg.lstsq(columns, start, rcond=1e-8)[0]
        return float(self._worth * np.log((left @ left + 1e-30) / self._named))

    def _sized(
        self, c: Candidate, start: np.ndarray, columns: np.ndarray, rest: np.ndarray
    ) -> tuple[float, Candidate | None]:
        """How far off a candidate is in a member's place, and the candidate with the size it then wants."""
        X = np.concatenate([rest, columns], axis=1)
        mine = np.linalg.lstsq(X, start, rcond=1e-8)[0][rest.shape[1] :]
        mine = mine * max(float(np.linalg.norm(mine)), 1.0) ** (1.0 / c.power - 1.0)
        sizes = {
            f: c.start.value(f) + float(np.clip(k, -30.0, 30.0)) * (c.push.value(f) - c.start.value(f))
            for f, k in zip(c.start.free, mine, strict=True)
        }
        push = c.push.moved(sizes)
        if all(abs(push.value(f) - c.start.value(f)) < 1e-9 for f in c.start.free):
            return np.inf, None  # it would have to act the wrong way round
        steps = {f: max(0.3 * abs(push.value(f) - c.start.value(f)), 0.1 * abs(c.steps[f])) for f in c.steps}
        return self._off(start, X), replace(c, push=push, steps=steps)


class _Fitted:
    """Other sets fitted by simulation, and how they compare with the final one."""

    def __init__(
        self,
        sim: Simulator,
        scene: ClothScene,
        fitted: list[ClothEpisode],
        heldout: list[ClothEpisode],
        found: ClothSearch,
    ) -> None:
        self._scene, self._found = scene, found
        self._fitter = ClothFitter(sim, fitted, found.weights)
        self._apart = ClothFitter(sim, heldout, found.weights)
        self._base = self._fitter.rss(found.fit.residuals) + 1e-30

    def fit(
        self, member: Candidate, rest: list[Candidate], other: Candidate | None = None, sought: bool = False
    ) -> ClothFit:
        """The rest of the set with another member or none, its place or instant looked for where that is `sought`."""
        model, chosen = self._found.fit.model.without(member.name), rest
        if other is not None:
            chosen = [*rest, other]
            model = begun(self._fitter, model, other, self._fitter.rss(self._fitter.residuals(model)))
        fit = self._fitter.fit(model, steps_of(chosen), rounds=2)
        if other is not None and sought and other.name in SOUGHT and SAME < self.worse(fit) < SEARCHED * SAME:
            fit = polish(self._fitter, fit, chosen, self._scene)
        elif SAME < self.worse(fit) < 2.0 * HOPELESS * SAME:
            fit = settled(self._fitter, fit, chosen)
        return fit

    def worse(self, fit: ClothFit) -> float:
        """By how much a fit explains the fitted recordings worse than the named set."""
        return float(self._found.worth * np.log((fit.rss + 1e-30) / self._base))

    def open(self, other: ClothFit, member: Candidate) -> bool:
        """Whether another set without a member may be right: it fits as well, or it does on other recordings."""
        worse = self.worse(other)
        if worse < SAME:
            return True
        if worse > DECISIVE * NUMBER * len(member.start.free) or not self._apart.episodes:
            return False
        before, after = (self._apart.rss(self._apart.residuals(m)) for m in (self._found.fit.model, other.model))
        rows, fitted = (sum(x.size for x in f.data) for f in (self._apart, self._fitter))
        return self._found.worth * rows / fitted * np.log(after / before) < float(chi2.isf(LEVEL, 1))

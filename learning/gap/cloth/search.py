"""Which effects a cloth recording lacks: screened with one simulation each, verified by fitting with simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from .candidates import Candidate, candidates, clash
from .exchange import SAME, Exchange, Other
from .fitting import ClothFit, ClothFitter, ClothModel
from .noise import Coherence, bursts, coherence, load_misfit, memory, neighbours
from .pairs import paired
from .polish import begun, polish, rested, settled, steps_of, sure
from .scene import ClothEpisode, ClothScene
from .screening import probe, screened
from .simulate import Simulator

ALPHA = 0.05
SCREENED = 2  # episodes hypotheses are verified on; they are screened on the worst of them, the final fit uses all
VERIFIED = 4  # candidates per round that are fitted by simulation
MAX_CHOSEN = 3  # effects and recalibrations at once
CARRIED = 0.8  # proxy bodies are taken as given where they alone bring the squares below this part
MATERIAL = 0.015  # a step must lower the mean square by this part of what it leaves
SHARE = 0.01  # and by this part of what is explained, unless it leaves nothing that neighbours share
HOPELESS = 3.0  # once one explains all, those screened this far off are not fitted any more
EXCHANGES = 3  # members that are exchanged at most
NUMBER = 10.0  # what a fitted number has to keep gaining to stay
TWOS = 3  # pairs that are fitted by simulation where the search begins,
HALF = 0.5  # if they leave less than this part of what the best single hypothesis does


@dataclass(frozen=True, kw_only=True)
class Tried:
    """One verified explanation: what is added in its round, the fit, the criterion."""

    added: tuple[Candidate, ...]
    fit: ClothFit
    score: float


@dataclass(frozen=True, kw_only=True)
class ClothSearch:
    """The result.

    Attributes:
        chosen: candidates in the model, in order.
        fit: the final fit.
        sure: the same with the intervals of all numbers that were fitted at some time.
        plain: the model as given.
        before, after: shared and unshared parts of its residual and of the final one.
        rivals: per chosen candidate, other names that fitted as well.
        worth: independent samples.
        weights: (columns,) one over the noise of each column.
    """

    chosen: tuple[Candidate, ...]
    fit: ClothFit
    sure: ClothFit
    plain: ClothFit
    before: Coherence
    after: Coherence
    rivals: dict[str, tuple[str, ...]]
    worth: float
    weights: np.ndarray


def search(sim: Simulator, scene: ClothScene, episodes: list[ClothEpisode], say: Callable[[str], None]) -> ClothSearch:
    """Rounds of screening and verification until no effect pays its price and none is better in another's place.

    Args:
        sim: runs the scene.
        scene: the cloth.
        episodes: recordings to be explained.
        say: told of every round.
    """
    rounds = _Rounds(sim, scene, episodes, say)
    for _ in range(EXCHANGES):
        while rounds.more and rounds.next():
            pass
        if not rounds.exchange():
            break
    return rounds.result()


class _Rounds:
    """What is known between two rounds: the effects chosen so far, their fit, and what it leaves."""

    def __init__(
        self, sim: Simulator, scene: ClothScene, episodes: list[ClothEpisode], say: Callable[[str], None]
    ) -> None:
        self._sim, self._scene, self._episodes, self._say = sim, scene, episodes, say
        self._markers = m = len(scene.markers)
        self._pairs = neighbours(scene.vertices[list(scene.markers)])
        first = ClothFitter(sim, episodes, np.ones(3 * m + (3 if episodes[0].load is not None else 0)))
        self._weights = _weights(first, m)
        self._fitter = ClothFitter(sim, episodes, self._weights)
        self._some = ClothFitter(sim, episodes[:SCREENED], self._weights)
        self._plain = self._start = self._fitter.fit(ClothModel(), {})
        carried = self._fitter.fit(ClothModel(carried=True), {})
        if carried.rss < CARRIED * self._plain.rss:
            self._start = carried  # recorded in a world whose cloth already has proxy bodies
        self._before = self._after = self._coherence(self._start)
        self._rows = sum(r.size for r in self._plain.residuals)
        self._worth = self._rows / memory(self._plain.residuals)
        self._fit, self._chosen = self._start, list[Candidate]()
        self._rivals: dict[str, tuple[str, ...]] = {}

    @property
    def more(self) -> bool:
        """Whether something is left to be explained and the model may still grow."""
        loads = [e.load for e in self._episodes]
        return len(self._chosen) < MAX_CHOSEN and (
            _shares(self._after)
            or load_misfit(self._fit.residuals, loads, self._markers) < 0.01
            or bursts(self._fit.residuals, self._markers) < 0.01
        )

    def next(self) -> bool:
        """One round; whether it added an effect."""
        pool = self._pool()
        self._say(f"round {len(self._chosen) + 1}: {len(pool)} hypotheses, {self._sim.runs} simulations so far")
        part = replace(self._some.fit(replace(self._fit.model, free=()), {}), model=self._fit.model)
        verified = self._verified(pool, part)
        if not verified:
            return False
        if not self._chosen:
            verified += self._twos(pool, part, min((fit for _, fit in verified), key=lambda f: f.rss))
        best = min((fit for _, fit in verified), key=lambda f: f.rss)
        count = sum(r.size for r in best.residuals)
        self._worth = count / memory(best.residuals)
        scored = [Tried(added=c, fit=f, score=self._score(f, f.model, count, len(pool) ** len(c))) for c, f in verified]
        scored.sort(key=lambda t: t.score - (3.0 if all(c.recalibration for c in t.added) else 0.0))
        top = scored[0]
        drop = part.rss - top.fit.rss
        explained = self._start.rss * count / self._rows - top.fit.rss
        now = self._score(part, self._fit.model, count, len(pool))
        if now - top.score <= 0 or drop < MATERIAL * top.fit.rss:
            return False
        polished = self._polished(top)
        after = self._coherence(polished)
        if drop < SHARE * explained and _shares(after):
            return False  # a large effect that is not quite right leaves something to mop up for any other
        self._fit, self._after = polished, after
        self._chosen.extend(top.added)
        names = {c.name for c in top.added}
        alike = [c.name for t in scored[1:] if t.score - top.score < SAME for c in t.added if c.name not in names]
        self._rivals |= dict.fromkeys(names, tuple(dict.fromkeys(alike)))
        return True

    def _polished(self, top: Tried) -> ClothFit:
        """What is added, with its places and instants looked for, one after the other."""
        fit = top.fit
        for last in top.added:
            others = [c for c in top.added if c is not last]
            fit = polish(self._fitter, fit, [*self._chosen, *others, last], self._scene)
        return fit

    def exchange(self) -> bool:
        """Put another hypothesis where a member explains noticeably less; whether there was one."""
        now = Other(chosen=tuple(self._chosen), fit=self._fit)
        around = Exchange(fitter=self._fitter, scene=self._scene, named=now, worth=self._worth)

        def price(other: Other) -> float:
            return around.worse(other) + NUMBER * max(other.numbers - now.numbers, 0)

        for member in now.chosen:
            best = min(around.instead(member), key=price, default=now)
            if price(best) < -SAME:
                self._say(f"rather {' and '.join(c.name for c in best.chosen)}")
                self._fit, self._chosen = _prune(self._fitter, best.fit, list(best.chosen), self._worth)
                self._after = self._coherence(self._fit)
                return True
        return False

    def result(self) -> ClothSearch:
        """The final model, without what later rounds made unnecessary."""
        fit, chosen = _prune(self._fitter, self._fit, self._chosen, self._worth)
        fit = rested(self._fitter, fit, chosen, self._worth) if chosen else fit
        return ClothSearch(
            chosen=tuple(chosen),
            fit=fit,
            sure=sure(self._fitter, fit, chosen) if chosen else fit,
            plain=self._plain,
            before=self._before,
            after=self._coherence(fit),
            rivals=self._rivals,
            worth=self._worth,
            weights=self._weights,
        )

    def _coherence(self, fit: ClothFit) -> Coherence:
        return coherence(fit.residuals, self._pairs, self._markers)

    def _pool(self) -> list[Candidate]:
        """Hypotheses that can join what is chosen."""
        taken = {c.name for c in self._chosen}
        every = candidates(self._scene, self._episodes, self._fitter.with_bodies(self._fit.model))
        return [c for c in every if c.name not in taken and not clash(c.name, taken)]

    def _worst(self, part: ClothFit) -> tuple[ClothFitter, ClothFit]:
        """The recording that a fit leaves most of, and the fit on it alone: what hypotheses are screened on."""
        worst = int(np.argmax([np.mean((r * self._weights) ** 2) for r in part.residuals]))
        alone = ClothFitter(self._sim, [self._some.episodes[worst]], self._weights)
        return alone, replace(part, residuals=[part.residuals[worst]], rss=alone.rss([part.residuals[worst]]))

    def _twos(
        self, pool: list[Candidate], part: ClothFit, single: ClothFit
    ) -> list[tuple[tuple[Candidate, ...], ClothFit]]:
        """Pairs that leave much less than the best single candidate, screened as those are, and fitted.

        None where that one leaves nothing that neighbours share.

        Args:
            pool: all candidates.
            part: the model without them on the recordings candidates are verified on.
            single: the best single candidate there.
        """
        if not _shares(self._coherence(single)):
            return []
        alone, seen = self._worst(part)
        own = alone.columns(seen.model, seen.residuals, {})
        pairs = paired(probe(alone, seen.model, pool, float(np.sqrt(seen.rss))), own)
        most = HALF * single.rss / max(part.rss, 1e-30)
        verified: list[tuple[tuple[Candidate, ...], ClothFit]] = []
        for pair in [p for p in pairs if p.left < most * seen.rss][:TWOS]:
            one, other = pair.members
            one = begun(self._some, part.model.joined(other.push), one, part.rss)
            other = begun(self._some, part.model.joined(one.push), other, part.rss)
            model = part.model.joined(one.push).joined(other.push)
            fit = self._some.fit(model, steps_of([one, other]), rounds=2)
            self._say(
                f"  {one.name} and {other.name}: {np.sqrt(fit.rss / max(part.rss, 1e-30)):.3f} of the residual left"
            )
            if fit.rss < HALF * single.rss:
                verified.append(((one, other), fit))
        return verified

    def _verified(self, pool: list[Candidate], part: ClothFit) -> list[tuple[tuple[Candidate, ...], ClothFit]]:
        """The best screened candidates, each fitted beside what is chosen.

        Args:
            pool: all candidates.
            part: what is chosen so far on the recordings candidates are verified on.
        """
        alone, seen = self._worst(part)
        own = alone.columns(seen.model, seen.residuals, steps_of(self._chosen))
        ranked, left = screened(alone, seen.model, own, pool, float(np.sqrt(seen.rss)))
        verified: list[tuple[tuple[Candidate, ...], ClothFit]] = []
        done = False  # once one explains all, the others only have to show whether they would too
        for k, likely in enumerate(ranked[:VERIFIED]):
            # screening saw one recording, fits see several
            least = min((f.rss for _, f in verified), default=0.0) * seen.rss / max(part.rss, 1e-30)
            if done and left[likely.name] > max(HOPELESS * least, 0.25 * seen.rss):
                continue
            c = begun(self._some, self._fit.model, likely, part.rss)
            first = self._fit.model.joined(c.push)
            joined = self._some.fit(first, steps_of([*self._chosen, c]), rounds=1 if done else 2)
            done = done or not _shares(self._coherence(joined))
            part_left = np.sqrt(joined.rss / max(part.rss, 1e-30))
            self._say(f"  {k + 1}/{VERIFIED} {c.name}: {part_left:.3f} of the residual left")
            verified.append(((c,), joined))
        return verified

    def _score(self, fit: ClothFit, model: ClothModel, count: int, tried: int) -> float:
        """The criterion, smaller is better: misfit over `count` samples, and the price of a model among `tried`."""
        return self._worth * np.log(fit.rss / count) + _price(tried, model)


def _shares(left: Coherence) -> bool:
    """Whether neighbours still share something material."""
    return left.p_value < 0.01 and left.shared > 0.03 * left.floor**2


def _weights(fitter: ClothFitter, markers: int) -> np.ndarray:
    """One over the short-term noise, shared by all marker columns and by all load columns."""
    residuals = fitter.residuals(ClothModel())
    jitter = [np.mean(np.diff(r, 2, axis=0) ** 2, axis=0) / 6.0 for r in residuals]
    power = np.mean(jitter, axis=0)
    marker = float(np.median(power[: 3 * markers])) + 1e-14
    out = np.full(len(power), 1.0 / np.sqrt(marker))
    if len(power) > 3 * markers:
        # a load is a few columns among many; it counts no more than its own noise and bias allow
        total = float(np.mean([np.mean(r[:, 3 * markers :] ** 2) for r in residuals]))
        out[3 * markers :] = 1.0 / np.sqrt(max(float(np.median(power[3 * markers :])), 0.02 * total) + 1e-14)
    return out


def _price(tried: int, model: ClothModel) -> float:
    return float(chi2.isf(ALPHA / max(tried, 1), 1)) * len(model.free)


def _prune(
    fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate], worth: float
) -> tuple[ClothFit, list[Candidate]]:
    """Take back what later rounds made unnecessary."""
    changed = True
    while changed and len(chosen) > 1:
        changed = False
        for c in list(chosen):
            rest = [x for x in chosen if x is not c]
            without = settled(fitter, fitter.fit(fit.model.without(c.name), steps_of(rest), rounds=2), rest)
            if (
                worth * np.log(without.rss / fit.rss) < NUMBER * len(c.start.free)
                or without.rss - fit.rss < MATERIAL * fit.rss
            ):
                fit, chosen, changed = without, rest, True
                break
    return fit, chosen

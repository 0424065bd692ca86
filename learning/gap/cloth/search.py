"""Which effects a cloth recording lacks: screened with one simulation each, verified by fitting with simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from .candidates import ONSETS, Candidate, candidates
from .catches import FINE, MOMENT, best_catch
from .fitting import ENOUGH, ClothFit, ClothFitter, ClothModel, Free, scaled
from .noise import Coherence, coherence, load_misfit, memory, neighbours
from .patches import best_patch
from .scene import ClothEpisode, ClothScene
from .simulate import Simulator

ALPHA = 0.05
SCREENED = 2  # episodes hypotheses are verified on; they are screened on the worst of them, the final fit uses all
VERIFIED = 4  # candidates per round that are fitted by simulation
MAX_CHOSEN = 3  # effects and recalibrations at once
CARRIED = 0.8  # proxy bodies are taken as given where they alone bring the squares below this part
MATERIAL = 0.015  # a step must lower the mean square by this part of what it leaves
SHARE = 0.01  # and by this part of what is explained, unless it leaves nothing that neighbours share
HOPELESS = 3.0  # once one explains all, those screened this far off are not fitted any more
NUMBER = 10.0  # what a fitted number has to keep gaining to stay
SPACING = 0.1  # between the instants a slip is screened at, over a recording's length
SAME = 12.0  # criterion within which two explanations fit alike
FINER = 0.1  # finite differences once a fit stands still, over those before
ONSET: Free = ("strain_stiffening", "onset")
BEND = 0.02  # finite difference of the onset [1]


@dataclass(frozen=True, kw_only=True)
class Tried:
    """One verified explanation: names added in its round, the fit, the criterion."""

    added: Candidate
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
    """Rounds of screening and verification until no effect pays its price.

    Args:
        sim: runs the scene.
        scene: the cloth.
        episodes: recordings to be explained.
        say: told of every round.
    """
    rounds = _Rounds(sim, scene, episodes, say)
    while rounds.more and rounds.next():
        pass
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
            _shares(self._after) or load_misfit(self._fit.residuals, loads, self._markers) < 0.01
        )

    def next(self) -> bool:
        """One round; whether it added an effect."""
        pool = self._pool()
        self._say(f"round {len(self._chosen) + 1}: {len(pool)} hypotheses, {self._sim.runs} simulations so far")
        part = replace(self._some.fit(replace(self._fit.model, free=()), {}), model=self._fit.model)
        verified = self._verified(pool, part)
        if not verified:
            return False
        best = min(verified, key=lambda x: x[1].rss)[1]
        count = sum(r.size for r in best.residuals)
        self._worth = count / memory(best.residuals)
        scored = [Tried(added=c, fit=f, score=self._score(f, f.model, count, len(pool))) for c, f in verified]
        scored.sort(key=lambda t: t.score - (3.0 if t.added.recalibration else 0.0))
        top = scored[0]
        drop = part.rss - top.fit.rss
        explained = self._start.rss * count / self._rows - top.fit.rss
        now = self._score(part, self._fit.model, count, len(pool))
        if now - top.score <= 0 or drop < MATERIAL * top.fit.rss:
            return False
        polished = polish(self._fitter, top.fit, [*self._chosen, top.added], self._scene)
        after = self._coherence(polished)
        if drop < SHARE * explained and _shares(after):
            return False  # a large effect that is not quite right leaves something to mop up for any other
        self._fit, self._after = polished, after
        self._chosen.append(top.added)
        alike = (t.added.name for t in scored[1:] if t.score - top.score < SAME and t.added.name != top.added.name)
        self._rivals[top.added.name] = tuple(dict.fromkeys(alike))
        return True

    def result(self) -> ClothSearch:
        """The final model, without what later rounds made unnecessary."""
        fit, chosen = _prune(self._fitter, self._fit, self._chosen, self._worth)
        return ClothSearch(
            chosen=tuple(chosen),
            fit=fit,
            sure=sure(self._fitter, fit, chosen),
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
        with_bodies = self._fitter.residuals(replace(self._fit.model, carried=True))
        taken = {c.name for c in self._chosen}
        every = candidates(self._scene, self._episodes, with_bodies)
        return [c for c in every if c.name not in taken and not clash(c.name, taken)]

    def _verified(self, pool: list[Candidate], part: ClothFit) -> list[tuple[Candidate, ClothFit]]:
        """The best screened candidates, each fitted beside what is chosen.

        Args:
            pool: all candidates.
            part: what is chosen so far on the recordings candidates are verified on.
        """
        worst = int(np.argmax([np.mean((r * self._weights) ** 2) for r in part.residuals]))
        alone = ClothFitter(self._sim, [self._some.episodes[worst]], self._weights)
        seen = replace(part, residuals=[part.residuals[worst]], rss=alone.rss([part.residuals[worst]]))
        ranked, left = _screen(self._sim, alone, seen, self._chosen, pool)
        verified: list[tuple[Candidate, ClothFit]] = []
        done = False  # once one explains all, the others only have to show whether they would too
        for k, c in enumerate(ranked[:VERIFIED]):
            # screening saw one recording, fits see several
            least = min((f.rss for _, f in verified), default=0.0) * seen.rss / max(part.rss, 1e-30)
            if done and left[c.name] > max(HOPELESS * least, 0.25 * seen.rss):
                continue
            first = begun(self._some, self._fit.model, c, part.rss)
            joined = self._some.fit(first, steps_of([*self._chosen, c]), rounds=1 if done else 2)
            done = done or not _shares(self._coherence(joined))
            part_left = np.sqrt(joined.rss / max(part.rss, 1e-30))
            self._say(f"  {k + 1}/{VERIFIED} {c.name}: {part_left:.3f} of the residual left")
            verified.append((c, joined))
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


def clash(name: str, taken: set[str]) -> bool:
    """Whether a hypothesis and one of those taken are the same load."""
    return (name == "added_mass" and "mass" in taken) or (name == "mass" and "added_mass" in taken)


def _price(tried: int, model: ClothModel) -> float:
    return float(chi2.isf(ALPHA / max(tried, 1), 1)) * len(model.free)


def steps_of(chosen: list[Candidate]) -> dict[Free, float]:
    """Finite difference of every number of some candidates."""
    return {f: s for c in chosen for f, s in c.steps.items()}


def _screen(
    sim: Simulator, fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate], pool: list[Candidate]
) -> tuple[list[Candidate], dict[str, float]]:
    """Candidates by how much a linear use of one simulation each would explain, best first, one of each name.

    Returns:
        The candidates, and the weighted sum of squares each would leave.
    """
    runs = []
    for c in pool:
        for f in c.start.free:
            model = fit.model.joined(c.start.moved({f: c.push.value(f)}))
            runs += [(e, model.acting, model.physics) for e in fitter.episodes]
    sim.ahead(runs)
    own = [fitter.columns(fit.model, fit.residuals, steps_of(chosen))] if chosen and fit.model.free else []
    scored = []
    for c in pool:
        base = fit.model.joined(c.start)
        r = fitter.residuals(base)
        flat = np.concatenate([(x * fitter.weights).ravel() for x in r])
        columns, sizes = list(own), {}
        for f in c.start.free:
            x = fitter.residuals(base.moved({f: c.push.value(f)}))
            column = np.concatenate([((a - b) * fitter.weights).ravel() for a, b in zip(r, x, strict=True)])
            columns.append(column[:, None])
        X = np.concatenate(columns, axis=1)
        theta = np.linalg.lstsq(X, flat, rcond=1e-8)[0]
        mine = theta[-len(c.start.free) :]
        mine = mine * max(float(np.linalg.norm(mine)), 1.0) ** (1.0 / c.power - 1.0)
        for f, k in zip(c.start.free, mine, strict=True):
            sizes[f] = c.start.value(f) + float(np.clip(k, -30.0, 30.0)) * (c.push.value(f) - c.start.value(f))
        left = float(np.sum((flat - X @ theta) ** 2))
        if c.name == "grip_slip":  # a moment, not a size: the simulation itself is the answer
            x = fitter.residuals(fit.model.joined(c.push))
            left, sizes = fitter.rss(x), {}
        push = c.push.moved(sizes) if sizes else c.push
        if all(abs(push.value(f) - c.start.value(f)) < 1e-9 for f in c.start.free):
            continue  # it would have to act the wrong way round
        steps = {f: 0.3 * abs(push.value(f) - c.start.value(f)) + 1e-6 if sizes else c.steps[f] for f in c.steps}
        steps = {f: max(s, 0.1 * abs(c.steps[f])) for f, s in steps.items()}
        scored.append((left, replace(c, push=push, steps=steps)))
    scored.sort(key=lambda pair: pair[0])
    firsts: dict[str, Candidate] = {}
    lefts: dict[str, float] = {}
    for left, c in scored:
        firsts.setdefault(c.name, c)
        lefts.setdefault(c.name, left)
    return list(firsts.values()), lefts


def begun(fitter: ClothFitter, model: ClothModel, c: Candidate, limit: float) -> ClothModel:
    """The model with a candidate at the size screened, or at less where so much of it is worse than none."""
    tried = model.joined(c.push)
    for factor in (0.3, 0.1):
        if c.name == "grip_slip" or fitter.rss(fitter.residuals(tried)) < limit:
            break
        tried = model.joined(scaled(c.push, factor, c.start))
    return tried


def _slipped(fitter: ClothFitter, fit: ClothFit, away: float) -> ClothFit:
    """Move the instant of a slip, from steps of `away` (over a recording's length) down to a few time steps."""
    away *= float(max(e.t[-1] for e in fitter.episodes))
    while away > 0.002:
        here = fit.model.value(("grip_slip", "time"))
        for t in (here - away, here + away):
            model = fit.model.moved({("grip_slip", "time"): t})
            residuals = fitter.residuals(model)
            if fitter.rss(residuals) < fit.rss:
                fit = replace(fit, model=model, residuals=residuals, rss=fitter.rss(residuals))
        away *= 0.6
    return fit


def _stiffened(fitter: ClothFitter, fit: ClothFit, steps: dict[Free, float]) -> ClothFit:
    """Fit from which stretch on cloth stiffens, and how much, from where that was and from the likeliest other one."""
    size: Free = ("strain_stiffening", "stiffness")
    others = fitter.sized([fit.model.moved({ONSET: x}) for x in ONSETS], fit.model.moved({size: 0.0}), size)
    starts = [fit.model, *(m for _, m in others if m.value(ONSET) != fit.model.value(ONSET))][:2]
    free = (*fit.model.free, ONSET)
    steps = {**steps, ONSET: BEND}
    best = min((fitter.fit(replace(m, free=free), steps, rounds=4) for m in starts), key=lambda each: each.rss)
    # much from a late stretch on and less from an earlier one are nearly the same: on until it stands still
    best = fitter.fit(best.model, {f: FINER * x for f, x in steps.items()}, rounds=8, least=FINE)
    return replace(best, model=replace(best.model, free=fit.model.free))


def polish(fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate], scene: ClothScene) -> ClothFit:
    """Fit what the screening fixed: where a mass sits or a place caught, and from when to when."""
    last = chosen[-1]
    seen = fitter.residuals(fit.model)  # it was verified on fewer recordings
    fit = replace(fit, residuals=seen, rss=fitter.rss(seen))
    if last.name == "added_mass":
        fit = best_patch(fitter, fit, scene, steps_of(chosen))
    if last.name == "snag":
        fit = best_catch(fitter, fit, scene, steps_of(chosen))
    if any(c.name == "grip_slip" for c in chosen):  # what is found later may have moved it
        fit = _slipped(fitter, fit, SPACING if last.name == "grip_slip" else 0.3 * SPACING)
    if any(c.name == ONSET[0] for c in chosen):  # the same holds for from which stretch on
        fit = _stiffened(fitter, fit, steps_of(chosen))
    return settled(fitter, fitter.fit(fit.model, steps_of(chosen), rounds=3), chosen)


def settled(fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate]) -> ClothFit:
    """The fit gone on with where smaller finite differences help it: beside its best values cloth bends within a step.

    A step is what matters while a size is looked for; near the end its differences point past the best values, and what
    is left there looks like another effect.
    """
    fine = fitter.fit(fit.model, {f: FINER * s for f, s in steps_of(chosen).items()}, rounds=5)
    return fine if fine.rss < (1.0 - ENOUGH) * fit.rss else fit


def sure(fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate]) -> ClothFit:
    """The fit with what was fitted once and then held free, too: without, the others look too sure."""
    end = float(max(e.t[-1] for e in fitter.episodes))
    held: dict[Free, float] = {ONSET: BEND, ("snag", "t0"): MOMENT * end, ("snag", "t1"): MOMENT * end}
    acting = {c.name for c in chosen}
    held = {f: s for f, s in held.items() if f[0] in acting}
    if not held:
        return fit
    steps = {f: FINER * s for f, s in {**steps_of(chosen), **held}.items()}
    return fitter.with_intervals(fit, (*fit.model.free, *held), steps)


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

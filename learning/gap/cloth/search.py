"""Which effects a cloth recording lacks: screened with one simulation each, verified by fitting with simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from .candidates import Candidate, candidates
from .catches import best_catch
from .fitting import ClothFit, ClothFitter, ClothModel, Free, scaled
from .noise import Coherence, coherence, load_misfit, memory, neighbours
from .patches import best_patch
from .scene import ClothEpisode, ClothScene
from .simulate import Simulator

ALPHA = 0.05
SCREENED = 2  # episodes hypotheses are verified on; they are screened on the worst of them, the final fit uses all
VERIFIED = 4  # candidates per round that are fitted by simulation
MOST = 3  # effects and recalibrations at once
CARRIED = 0.8  # carriers are taken as given where they alone bring the squares below this part
MATERIAL = 0.015  # a step must lower the mean square by this part of what it leaves
SHARE = 0.01  # and by this part of what is explained, unless it leaves nothing that neighbours share
HOPELESS = 3.0  # once one explains all, those screened this far off are not fitted any more
NUMBER = 10.0  # what a fitted number has to keep gaining to stay
SPACING = 0.1  # between the instants a slip is screened at, over a recording's length
SAME = 12.0  # criterion within which two explanations fit alike


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
        plain: the model as given.
        before, after: shared and unshared parts of its residual and of the final one.
        rivals: per chosen candidate, other names that fitted as well.
        worth: independent samples.
    """

    chosen: tuple[Candidate, ...]
    fit: ClothFit
    plain: ClothFit
    before: Coherence
    after: Coherence
    rivals: dict[str, tuple[str, ...]]
    worth: float


def search(sim: Simulator, scene: ClothScene, episodes: list[ClothEpisode], say: Callable[[str], None]) -> ClothSearch:
    """Rounds of screening and verification until no effect pays its price."""
    m = len(scene.markers)
    pairs = neighbours(scene.vertices[list(scene.markers)])
    first = ClothFitter(sim, episodes, np.ones(3 * m + (3 if episodes[0].load is not None else 0)))
    weights = _weights(first, m)
    fitter = ClothFitter(sim, episodes, weights)
    some = ClothFitter(sim, episodes[:SCREENED], weights)
    plain = fitter.fit(ClothModel(), {})
    before = coherence(plain.residuals, pairs, m)
    start = plain
    carried = fitter.fit(ClothModel(carried=True), {})
    if carried.rss < CARRIED * plain.rss:
        start = carried  # recorded in a world whose cloth already has carriers
        before = coherence(start.residuals, pairs, m)
    rows = sum(r.size for r in plain.residuals)
    chosen: list[Candidate] = []
    fit, rivals = start, {}
    worth = rows / memory(plain.residuals)
    after = before
    loads = [e.load for e in episodes]
    while len(chosen) < MOST and (_shares(after) or load_misfit(fit.residuals, loads, m) < 0.01):
        pool = candidates(scene, episodes, fitter.residuals(replace(fit.model, carried=True)))
        taken = {c.name for c in chosen}
        pool = [c for c in pool if c.name not in taken and not _clash(c.name, taken)]
        say(f"round {len(chosen) + 1}: {len(pool)} hypotheses, {sim.runs} simulations so far")
        part = some.fit(replace(fit.model, free=()), {})
        part = replace(part, model=fit.model)
        worst = int(np.argmax([np.mean((r * weights) ** 2) for r in part.residuals]))
        alone = ClothFitter(sim, [some.episodes[worst]], weights)
        seen = replace(part, residuals=[part.residuals[worst]], rss=alone.rss([part.residuals[worst]]))
        ranked, left = _screen(sim, alone, seen, chosen, pool)
        tried = []
        done = False  # once one explains all, the others only have to show whether they would too
        for k, c in enumerate(ranked[:VERIFIED]):
            # screening saw one recording, fits see several
            least = min((f.rss for _, f in tried), default=0.0) * seen.rss / max(part.rss, 1e-30)
            if done and left[c.name] > max(HOPELESS * least, 0.25 * seen.rss):
                continue
            begun = _begun(some, fit.model, c, part.rss)
            joined = some.fit(begun, _steps([*chosen, c]), rounds=1 if done else 2)
            done = done or not _shares(coherence(joined.residuals, pairs, m))
            say(f"  {k + 1}/{VERIFIED} {c.name}: {np.sqrt(joined.rss / max(part.rss, 1e-30)):.3f} of the residual left")
            tried.append((c, joined))
        if not tried:
            break
        best = min(tried, key=lambda x: x[1].rss)
        count = sum(r.size for r in best[1].residuals)
        worth = count / memory(best[1].residuals)
        scored = [
            Tried(added=c, fit=f, score=worth * np.log(f.rss / count) + _price(len(pool), f.model)) for c, f in tried
        ]
        scored.sort(key=lambda t: t.score - (3.0 if t.added.recalibration else 0.0))
        top = scored[0]
        now = worth * np.log(part.rss / count) + _price(len(pool), fit.model)
        drop = part.rss - top.fit.rss
        explained = start.rss * count / rows - top.fit.rss
        if now - top.score <= 0 or drop < MATERIAL * top.fit.rss:
            break
        polished = _polish(fitter, top.fit, [*chosen, top.added], scene)
        left_over = coherence(polished.residuals, pairs, m)
        if drop < SHARE * explained and _shares(left_over):
            break  # a large effect that is not quite right leaves something to mop up for any other
        fit, after = polished, left_over
        chosen.append(top.added)
        rivals[top.added.name] = tuple(
            dict.fromkeys(
                t.added.name for t in scored[1:] if t.score - top.score < SAME and t.added.name != top.added.name
            )
        )
    fit, chosen = _prune(fitter, fit, chosen, worth, rows)
    after = coherence(fit.residuals, pairs, m)
    return ClothSearch(
        chosen=tuple(chosen), fit=fit, plain=plain, before=before, after=after, rivals=rivals, worth=worth
    )


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


def _clash(name: str, taken: set[str]) -> bool:
    return (name == "added_mass" and "mass" in taken) or (name == "mass" and "added_mass" in taken)


def _price(tried: int, model: ClothModel) -> float:
    return float(chi2.isf(ALPHA / max(tried, 1), 1)) * len(model.free)


def _steps(chosen: list[Candidate]) -> dict[Free, float]:
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
    own = [fitter._columns(fit.model, fit.residuals, _steps(chosen))] if chosen and fit.model.free else []
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


def _begun(fitter: ClothFitter, model: ClothModel, c: Candidate, limit: float) -> ClothModel:
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


def _polish(fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate], scene: ClothScene) -> ClothFit:
    """Fit what the screening fixed: where a mass sits or a place caught, and from when to when."""
    last = chosen[-1]
    seen = fitter.residuals(fit.model)  # it was verified on fewer recordings
    fit = replace(fit, residuals=seen, rss=fitter.rss(seen))
    if last.name == "added_mass":
        fit = best_patch(fitter, fit, scene, _steps(chosen))
    if last.name == "snag":
        fit = best_catch(fitter, fit, scene, _steps(chosen))
    if any(c.name == "grip_slip" for c in chosen):  # what is found later may have moved it
        fit = _slipped(fitter, fit, SPACING if last.name == "grip_slip" else 0.3 * SPACING)
    if last.name == "strain_stiffening":  # from which stretch on
        free = (*fit.model.free, ("strain_stiffening", "onset"))
        bent = fitter.fit(replace(fit.model, free=free), {**_steps(chosen), ("strain_stiffening", "onset"): 0.02}, 4)
        fit = replace(bent, model=replace(bent.model, free=fit.model.free))
    return fitter.fit(fit.model, _steps(chosen), rounds=3)


def _prune(
    fitter: ClothFitter, fit: ClothFit, chosen: list[Candidate], worth: float, rows: int
) -> tuple[ClothFit, list[Candidate]]:
    """Take back what later rounds made unnecessary."""
    changed = True
    while changed and len(chosen) > 1:
        changed = False
        for c in list(chosen):
            rest = [x for x in chosen if x is not c]
            without = fitter.fit(fit.model.without(c.name), _steps(rest), rounds=2)
            if (
                worth * np.log(without.rss / fit.rss) < NUMBER * len(c.start.free)
                or without.rss - fit.rss < MATERIAL * fit.rss
            ):
                fit, chosen, changed = without, rest, True
                break
    return fit, chosen

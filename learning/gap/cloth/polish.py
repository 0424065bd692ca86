"""Fits beyond sizes: where an effect that was screened begins, and then its place, its instants and its onset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .candidates import MOMENT, ONSETS, Candidate, is_moment
from .catches import FINE, best_catch
from .fitting import ENOUGH, ClothFit, ClothFitter, ClothModel, Free, scaled
from .patches import best_patch
from .scene import ClothScene

SPACING = 0.1  # between the instants a slip is screened at, over a recording's length
FINER = 0.1  # finite differences once a fit stands still, over those before
ONSET: Free = ("strain_stiffening", "onset")
LESS = (0.3, 0.1, 0.03, 0.01)  # parts of the size screened that are tried as well
BEND = 0.02  # finite difference of the onset [1]
INSTANTS: frozenset[Free] = frozenset({("snag", "t0"), ("snag", "t1"), ("grip_slip", "time")})
STILL = 0.1  # criterion that one more round has to gain at the end; an interval reaches to where 4 are lost
RESTED = 10  # rounds at most until then


def steps_of(chosen: Sequence[Candidate]) -> dict[Free, float]:
    """Finite difference of every number of some candidates."""
    return {f: s for c in chosen for f, s in c.steps.items()}


def begun(fitter: ClothFitter, model: ClothModel, c: Candidate, limit: float) -> Candidate:
    """The candidate at the size screened, or at less where that explains more: what sticks or brakes much saturates.

    Args:
        fitter: of the recordings.
        model: what acts beside it.
        c: the candidate as it was screened.
        limit: weighted sum of squares without it, which no size that is begun with should exceed.

    Returns:
        The candidate, its push and its finite differences that much smaller.
    """
    best, least = c, fitter.rss(fitter.residuals(model.joined(c.push)))
    for factor in () if is_moment(c) else LESS:
        tried = replace(c, push=scaled(c.push, factor, c.start), steps={f: factor * s for f, s in c.steps.items()})
        left = fitter.rss(fitter.residuals(model.joined(tried.push)))
        if least <= min(left, limit):
            break
        if left < least:
            best, least = tried, left
    return best


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


def _stiffened(fitter: ClothFitter, fit: ClothFit, steps: dict[Free, float], anew: bool) -> ClothFit:
    """Fit from which stretch on cloth stiffens, and how much; where `anew`, from the likeliest other one as well."""
    size: Free = ("strain_stiffening", "stiffness")
    starts = [fit.model]
    if anew:
        sized = fitter.sized([fit.model.moved({ONSET: x}) for x in ONSETS], fit.model.moved({size: 0.0}), size)
        starts += [m for _, m in sized if m.value(ONSET) != fit.model.value(ONSET)][:1]
    free = (*fit.model.free, ONSET)
    steps = {**steps, ONSET: BEND}
    best = min((fitter.fit(replace(m, free=free), steps, rounds=4) for m in starts), key=lambda each: each.rss)
    # much from a late stretch on and less from an earlier one are nearly the same: on until it stands still
    best = fitter.fit(best.model, {f: FINER * x for f, x in steps.items()}, rounds=8, least=FINE)
    return replace(best, model=replace(best.model, free=fit.model.free))


def polish(
    fitter: ClothFitter, fit: ClothFit, chosen: Sequence[Candidate], scene: ClothScene, anew: bool = True
) -> ClothFit:
    """Fit what the screening fixed: where a mass sits or a place caught, and from when to when.

    Args:
        fitter: of the recordings.
        fit: the fit.
        chosen: what is in it; of the last one places and instants are looked for.
        scene: the cloth.
        anew: whether the stretch from which cloth stiffens is looked for from elsewhere, too.
    """
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
        fit = _stiffened(fitter, fit, steps_of(chosen), anew or last.name == ONSET[0])
    return settled(fitter, fitter.fit(fit.model, steps_of(chosen), rounds=3), chosen)


def settled(fitter: ClothFitter, fit: ClothFit, chosen: Sequence[Candidate]) -> ClothFit:
    """The fit gone on with where smaller finite differences help it: beside its best values cloth bends within a step.

    A step is what matters while a size is looked for; near the end its differences point past the best values, and what
    is left there looks like another effect.
    """
    fine = fitter.fit(fit.model, _finer(steps_of(chosen)), rounds=5)
    return fine if fine.rss < (1.0 - ENOUGH) * fit.rss else fit


def rested(fitter: ClothFitter, fit: ClothFit, chosen: Sequence[Candidate], worth: float) -> ClothFit:
    """The fit gone on with, all that was ever fitted free, until a round gains next to nothing.

    While effects are compared a fit may stop at a part of the sum of squares that is small beside what any of them
    explains.  It is as much as that sum grows from the best value to the end of its interval, though.

    Args:
        fitter: of the recordings.
        fit: the fit.
        chosen: what is in it.
        worth: independent samples.
    """
    held = _held(chosen)
    model, steps = replace(fit.model, free=(*fit.model.free, *held)), _finer({**steps_of(chosen), **held})
    best = fitter.fit(model, steps, rounds=RESTED, least=STILL / worth)
    k = len(fit.model.free)
    return replace(best, model=replace(best.model, free=fit.model.free), half=best.half[:k])


def sure(fitter: ClothFitter, fit: ClothFit, chosen: Sequence[Candidate]) -> ClothFit:
    """The fit with what was fitted once and then held free, too: without, the others look too sure."""
    held = _held(chosen)
    if not held:
        return fit
    return fitter.with_intervals(fit, (*fit.model.free, *held), _finer({**steps_of(chosen), **held}))


def _held(chosen: Sequence[Candidate]) -> dict[Free, float]:
    """Numbers that are fitted with a member and then held, with their finite differences."""
    held: dict[Free, float] = {ONSET: BEND, ("snag", "t0"): MOMENT, ("snag", "t1"): MOMENT}
    acting = {c.name for c in chosen}
    return {f: s for f, s in held.items() if f[0] in acting}


def _finer(steps: dict[Free, float]) -> dict[Free, float]:
    """Smaller finite differences; not of instants, which a simulation knows to one of its steps only."""
    return {f: s if f in INSTANTS else FINER * s for f, s in steps.items()}

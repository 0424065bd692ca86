"""Which set of effects explains the drops: every set of up to two effects is fitted and compared.

Drops are few and short, and their noise is coloured (a tracked ball wanders by a pixel for several frames), so a
sample is worth 1 / widening of an independent one.  Large changes of scale or of weight are implausible beforehand:
a height scale is usually right within 3 %, and the lift of air follows from mass and diameter where both are known.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.stats import chi2

from ....sim.effects.body_bank import BODY_EFFECTS
from ....sim.effects.buoyancy import AIR_DENSITY
from .fit import MODES, Drop, DropFit, fit_drops

SEARCHED = ("linear_drag", "quadratic_drag", "buoyancy", "gain_error", "wind")
IMPOSSIBLE = ({"quadratic_drag", "wind"}, {"buoyancy", "gain_error"})
PLAUSIBLE = {"gain_error": ("fraction", 0.0, 0.03), "buoyancy": ("fraction", 0.0, 0.03), "wind": ("speed", 0.0, 3.0)}
ALPHA = 0.05
FITTED = 1.3
FORESEEN = 6.0  # what it is worth that a value was known before the drops were seen
MATERIAL = 0.15  # an effect's own part over the noise, root mean square


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A set of effects, fitted and priced.  score: the criterion, smaller is better."""

    fit: DropFit
    score: float


@dataclass(frozen=True, kw_only=True)
class DropSearch:
    """All candidates, best first.

    Attributes:
        candidates: best first.
        widening: how many samples are worth one.
        price: of one parameter.
        floor: root mean square the richest fit leaves [m].
        rows: samples.
    """

    candidates: tuple[Candidate, ...]
    widening: float
    price: float
    floor: float
    rows: int

    @property
    def given(self) -> DropFit:
        """The model as given, with the release instants it needs."""
        return min((c for c in self.candidates if not c.fit.names), key=lambda c: c.score).fit

    @property
    def best(self) -> DropFit:
        """The chosen fit."""
        return self.candidates[0].fit


def widening_of(residuals: list[np.ndarray]) -> float:
    """Variance inflation of a mean-like coefficient from residual autocorrelation, bias-corrected, at least 1."""
    n = sum(len(r) for r in residuals)
    zero = sum(float(r @ r) for r in residuals) + 1e-30
    first = sum(float(r[1:] @ r[:-1]) for r in residuals) / zero
    first = min(max(first + (1.0 + 4.0 * max(first, 0.0)) / n, 0.0), 0.97)
    running, best = 1.0, 1.0
    for k in range(1, max(2, min(len(r) for r in residuals) // 4)):
        running += 2.0 * sum(float(r[k:] @ r[:-k]) for r in residuals) / zero
        best = max(best, running)
    # fitted residuals forget faster than the noise did
    return max((1.0 + first) / (1.0 - first), best) * FITTED


def search(drops: list[Drop], mass: float | None, diameter: float | None) -> DropSearch:
    """Fit every plausible set and rank them."""
    sets: list[tuple[str, ...]] = [(), *((n,) for n in SEARCHED)]
    sets += [p for p in combinations(SEARCHED, 2) if set(p) not in IMPOSSIBLE]
    fits = [
        fit_drops(drops, names, mode) for mode in MODES for names in sets if mode != "late" or len(drops) >= 3
    ]  # one or two drops cannot tell late from each at its own instant
    rows = sum(len(d.t) for d in drops)
    cleanest = min(fits, key=lambda f: f.rss)
    spent = len(cleanest.theta) + 2 * len(drops)
    floor2 = cleanest.rss / max(rows - spent, 1)
    widening = widening_of(cleanest.residuals)
    worth = max(rows - spent, 4) / widening
    price = max(float(chi2.isf(ALPHA / (2.0 * len(SEARCHED) * len(MODES)), 1)), worth * MATERIAL**2)
    candidates = []
    for fit in fits:
        instants = {"together": 0, "late": 1, "free": len(drops)}[fit.mode]
        score = worth * np.log(max(fit.rss, 1e-12) / rows) + price * (len(fit.theta) + instants)
        score += implausibility(fit, mass, diameter) - foreseen(fit.names, mass, diameter)
        candidates.append(Candidate(fit=fit, score=float(score)))
    candidates.sort(key=lambda c: c.score)
    return DropSearch(
        candidates=tuple(candidates), widening=widening, price=price, floor=float(np.sqrt(floor2)), rows=rows
    )


def foreseen(names: tuple[str, ...], mass: float | None, diameter: float | None) -> float:
    """Discount on the price of effects whose value size and mass foretell: such a fit could not bend as it likes."""
    return FORESEEN if "buoyancy" in names and mass and diameter else 0.0


def implausibility(fit: DropFit, mass: float | None, diameter: float | None) -> float:
    """Squared distance of the values from what is known beforehand, in standard deviations."""
    total = 0.0
    for name, (parameter, centre, spread) in PLAUSIBLE.items():
        if name not in fit.names:
            continue
        if name == "buoyancy" and mass and diameter:
            centre = AIR_DENSITY * np.pi / 6.0 * diameter**3 / mass
            spread = 0.1 * centre + 1e-4  # a diameter within 2 %, the weather
        total += ((fit.values[name][parameter] - centre) / spread) ** 2
    return total


def equals(found: DropSearch, name: str) -> list[tuple[str, DropFit]]:
    """Sets that differ from the best in one effect only and fit as well: (replacement, fit)."""
    best = found.candidates[0]
    rest = set(best.fit.names) - {name}
    out = []
    for c in found.candidates[1:]:
        other = set(c.fit.names) - rest
        if rest <= set(c.fit.names) and len(c.fit.names) == len(best.fit.names) and c.score - best.score < 6.0:
            new = next(iter(other))
            if name not in BODY_EFFECTS[new].contains and new not in [n for n, _ in out]:
                out.append((new, c.fit))
    return out

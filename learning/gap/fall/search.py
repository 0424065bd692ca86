"""Which set of effects explains the drops: every set of up to two effects is fitted and compared.

Drops are few and short and their noise is coloured (a tracked ball wanders by a pixel for several frames).  All sets
are first fitted plainly, the richest tells the noise's colour, and with it all are fitted again.  The sets near the
best are then compared under every colour that is the likeliest for one of them.  Large changes of scale or of weight
are implausible beforehand: a height scale is usually right within 3 %, and the lift of air follows from mass and
diameter where both are known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np

from ....sim.effects.body.body_registry import BODY_EFFECTS
from ....sim.effects.body.buoyancy import AIR_DENSITY
from .colour import Colour, estimated, grid
from .fit import MODES, Drop, DropFit, fit_drops, instants_of

SEARCHED = ("linear_drag", "quadratic_drag", "buoyancy", "gain_error", "wind")
IMPOSSIBLE = ({"quadratic_drag", "wind"}, {"buoyancy", "gain_error"})
PLAUSIBLE = {"gain_error": ("fraction", 0.0, 0.03), "buoyancy": ("fraction", 0.0, 0.03), "wind": ("speed", 0.0, 3.0)}
NUMBER = 5.0  # what one more number costs: along it noise gains as much with probability 2.5 %
EFFECT = 2.0  # and one more effect beside it: fewer are likelier, e : 1
FIRST = 3.0  # the first also has to beat the number of sets tried
FORESEEN = 6.0  # what it is worth that a value was known before the drops were seen
CLOSE = 30.0  # criterion beyond the best from which on a set's own noise is not worked out
SAME = 6.0  # criterion within which two sets fit alike
MOST_EQUAL = 4
MOST_RIVALS = 6
MOST_BESIDE = 3  # effects told that could act beside the named ones unseen
HIDES = 1.0  # over the noise, from which on such an effect is told
LARGEST = 2  # effects of a set that is named: with a third, five or six numbers follow any smooth force
DRAUGHT = 1.0  # [m/s] of air that still air cannot be told from quadratic drag in, below which it is that
MATERIAL = 0.05  # an effect's own part over the noise, root mean square, both whitened


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A set of effects, fitted and priced.

    Attributes:
        fit: the set.
        score: the criterion, smaller is better.
        misfit: the same without the price of the set.
    """

    fit: DropFit
    score: float
    misfit: float

    @property
    def effects(self) -> frozenset[str]:
        """Names, with `delay` where all drops are released equally late."""
        return frozenset(self.fit.names) | ({"delay"} if self.fit.mode == "late" else set())


@dataclass(frozen=True, kw_only=True)
class DropSearch:
    """All candidates, best first.

    Attributes:
        candidates: best first.
        drops: the drops with their noise's colour.
        colour: of the noise.
        worth: samples beyond those the fit takes up.
        price: of one number.
        floor: root mean square the richest fit leaves [m].
        rows: samples.
    """

    candidates: tuple[Candidate, ...]
    drops: tuple[Drop, ...]
    colour: Colour
    worth: float
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

    def refit(self, names: tuple[str, ...], mode: str) -> DropFit:
        """Another set on the same drops."""
        return fit_drops(list(self.drops), names, mode)


def search(drops: list[Drop], mass: float | None, diameter: float | None) -> DropSearch:
    """Fit every plausible set and rank them.

    Args:
        drops: to be explained.
        mass: of the body [kg], None where it is not known.
        diameter: of the body [m], None where it is not known.
    """
    plain = [fit_drops(drops, names, mode) for mode, names in _sets(drops)]
    colours = grid([d.t for d in drops])
    cleanest = min(plain, key=lambda f: f.rss)
    white = _coloured(drops, estimated(colours, np.concatenate(cleanest.residuals), cleanest.jacobian))
    fits = [fit_drops(white, f.names, f.mode, near=f) for f in plain]
    rows = sum(len(d.t) for d in drops)
    spent = len(cleanest.theta) + 2 * len(drops)
    worth = float(max(rows - spent, 4))
    number = max(NUMBER, worth * MATERIAL**2)
    price = partial(_price, drops=len(drops), number=number, mass=mass, diameter=diameter)
    rough = [worth * float(np.log(max(f.rss, 1e-12) / rows)) + price(f) for f in fits]
    # what is implausible beforehand may still fit as well, and has to be told as an equal
    best_rough = rough.index(min(rough))
    alike = worth * float(np.log(max(fits[best_rough].rss, 1e-12))) + SAME
    numbers = _numbers(fits[best_rough], drops)
    near = [
        score - min(rough) < CLOSE
        or (worth * float(np.log(max(f.rss, 1e-12))) < alike and _numbers(f, drops) <= numbers)
        for f, score in zip(fits, rough, strict=True)
    ]
    beside = {(f.mode, _twin(f.names)) for f, n in zip(fits, near, strict=True) if n}
    near = [n or (f.mode, frozenset(f.names)) in beside for f, n in zip(fits, near, strict=True)]
    close = [f for f, n in zip(fits, near, strict=True) if n]
    candidates = _under_likely_colours(drops, close, colours, worth, price)
    behind = max(c.score for c in candidates) - min(rough)
    far = [(f, x) for f, x, n in zip(fits, rough, near, strict=True) if not n]
    candidates += [Candidate(fit=f, score=behind + x, misfit=behind + x - price(f)) for f, x in far]
    candidates.sort(key=lambda c: c.score)
    best = candidates[0].fit
    noise = estimated(colours, np.concatenate(best.residuals), best.jacobian)
    return DropSearch(
        candidates=tuple(candidates),
        drops=tuple(_coloured(drops, noise)),
        colour=noise,
        worth=worth,
        price=number,
        floor=float(np.sqrt(cleanest.rss / max(rows - spent, 1))),
        rows=rows,
    )


TWINS = {"gain_error": "buoyancy", "buoyancy": "gain_error"}
"""At one mass a body that weighs less reads as one whose height is scaled down, whatever acts beside."""


def _twin(names: Iterable[str]) -> frozenset[str]:
    """The set in which the one stands for the other."""
    return frozenset(TWINS.get(n, n) for n in names)


def _numbers(fit: DropFit, drops: list[Drop]) -> int:
    """How many numbers a set has beside the heights of release."""
    return len(fit.theta) + instants_of(fit.mode, len(drops))


def _sets(drops: list[Drop]) -> list[tuple[str, tuple[str, ...]]]:
    """Assumption on the release instants and names of every set that these drops can bear."""
    sets: list[tuple[str, ...]] = [(), *((n,) for n in SEARCHED)]
    sets += [p for p in combinations(SEARCHED, 2) if set(p) not in IMPOSSIBLE]
    # one or two drops cannot tell late from each at its own instant
    tried = [(mode, names) for mode in MODES for names in sets if mode != "late" or len(drops) >= 3]
    if any(d.factor != 1.0 for d in drops):  # two effects and an instant for every drop would follow any smooth force
        tried = [(mode, names) for mode, names in tried if mode != "free" or len(names) < LARGEST]
    return tried


def _price(fit: DropFit, drops: int, number: float, mass: float | None, diameter: float | None) -> float:
    paid = price_of(fit.names, fit.mode, drops, number) - foreseen(fit.names, mass, diameter)
    return paid + implausibility(fit, mass, diameter)


def _under_likely_colours(
    drops: list[Drop], close: list[DropFit], colours: list[Colour], worth: float, price: Callable[[DropFit], float]
) -> list[Candidate]:
    """Each of the best sets under that noise which suits it best, of those that are the likeliest for one of them."""
    rows = sum(len(d.t) for d in drops)
    # a set that bends away from the drops may call its misfit slow noise, at that noise's price
    own = [estimated(colours, np.concatenate(f.residuals), f.jacobian) for f in close]
    likely = {(c.memory, c.slow): c for c in own}
    candidates = []
    for fit in close:
        options = []
        for c in likely.values():
            other = fit_drops(_coloured(drops, c), fit.names, fit.mode, near=fit)
            deviance = rows * float(np.log(max(other.rss, 1e-12) / rows)) + c.volume
            # what a fit takes up itself does not count
            misfit = worth / rows * deviance
            options.append(Candidate(fit=other, score=misfit + price(other), misfit=misfit))
        # how well a set fits is asked apart from how implausible its values are, which may prefer another colour
        fits_best = min(o.misfit for o in options)
        candidates.append(replace(min(options, key=lambda o: o.score), misfit=fits_best))
    return candidates


def _coloured(drops: list[Drop], colour: Colour) -> list[Drop]:
    return [replace(d, white=w) for d, w in zip(drops, colour.white, strict=True)]


def price_of(names: tuple[str, ...], mode: str, drops: int, number: float) -> float:
    """What a set has to gain: for each number, for each effect, and for being the first."""
    numbers = sum(len(BODY_EFFECTS[n].parameters) for n in names) + instants_of(mode, drops)
    effects = len(names) + (mode != "together")
    return numbers * number + effects * EFFECT + (FIRST if effects else 0.0)


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
            centre = air_lift(mass, diameter)
            spread = 0.1 * centre + 1e-4  # a diameter within 2 %, the weather
        total += ((fit.values[name][parameter] - centre) / spread) ** 2
    return total


def air_lift(mass: float, diameter: float) -> float:
    """Share of a ball's weight [kg] that the air it displaces carries, by its diameter [m]."""
    return AIR_DENSITY * np.pi / 6.0 * diameter**3 / mass


def rivals(found: DropSearch, fit: DropFit, most: int = MOST_RIVALS) -> list[Candidate]:
    """Other sets of up to two effects that fit as well, likeliest first; those that only add to the set are left out.

    What a set costs is not counted: the price says which explanation is likelier, not which the drops rule out.
    """
    mine = next(c for c in found.candidates if c.fit.names == fit.names and c.fit.mode == fit.mode)
    out: dict[frozenset[str], Candidate] = {}
    for c in found.candidates:
        if not c.effects or len(c.effects) > LARGEST or c.effects >= mine.effects:
            continue
        if c.misfit - mine.misfit >= SAME:
            continue
        if "free" in (c.fit.mode, mine.fit.mode) and c.fit.mode != mine.fit.mode:
            continue
        out.setdefault(c.effects, c)
    likely = dict(list(out.items())[:most])
    # a twin is told, however implausible it is beforehand
    twins = {_twin(n): out[_twin(n)] for n in (mine.effects, *likely) if _twin(n) in out}
    return list({**likely, **twins}.values())


def beside(found: DropSearch, fit: DropFit, most: int = MOST_BESIDE) -> list[Candidate]:
    """The set with one effect more that could be as large as the noise unseen, the best hidden first."""
    mine = next(c for c in found.candidates if c.fit.names == fit.names and c.fit.mode == fit.mode)
    out = []
    for c in found.candidates:
        more = c.effects - mine.effects
        if not (mine.effects and mine.effects < c.effects and len(more) == 1 and len(c.effects) <= LARGEST):
            continue
        if "free" in (c.fit.mode, mine.fit.mode) and c.fit.mode != mine.fit.mode:
            continue
        load = _hidden(found, c.fit, next(iter(more)))
        if load > HIDES * found.floor:
            out.append((load, c))
    return [c for _, c in sorted(out, key=lambda pair: -pair[0])][:most]


def _hidden(found: DropSearch, fit: DropFit, name: str) -> float:
    """Root mean square [m] that one effect of a fit may reach within two standard errors of its numbers."""
    J = fit.jacobian
    size = np.linalg.norm(J, axis=0) + 1e-12
    white = found.colour.apply(J / size)
    error = np.sqrt(np.diag(np.linalg.pinv(white.T @ white, rcond=1e-12, hermitian=True)) * fit.rss / found.worth)
    first = len(fit.theta) + len(found.drops)  # of the release instants
    if name != "delay":
        first = sum(len(BODY_EFFECTS[n].parameters) for n in fit.names[: fit.names.index(name)])
    count = 1 if name == "delay" else len(BODY_EFFECTS[name].parameters)
    return 2.0 * float(error[first : first + count].max()) / float(np.sqrt(len(J)))


def equals(found: DropSearch, name: str, fit: DropFit) -> list[tuple[str, DropFit]]:
    """What could stand in for one effect of a fit, the others unchanged, and fit as well: (replacement, fit)."""
    mine = next(c for c in found.candidates if c.fit.names == fit.names and c.fit.mode == fit.mode)
    rest = mine.effects - {name}
    out = []
    for c in rivals(found, fit, most=len(found.candidates)):
        if not rest <= c.effects or name in c.effects or not c.effects - rest:
            continue
        still = "wind" in c.effects - rest and abs(c.fit.values["wind"]["speed"]) < DRAUGHT
        if not (name == "quadratic_drag" and still):
            out.append((" + ".join(sorted(c.effects - rest)), c.fit))
    return out[:MOST_EQUAL]

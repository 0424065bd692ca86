"""The four steps for a dropped body."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from scipy.stats import chi2

from ....sim.effects.body.body_registry import BODY_EFFECTS
from ....sim.effects.effect import Parameter
from ..findings import EffectFinding, FollowUp, Gap, Placebo, Rival, Value, VerdictName, Where
from ..pictures import Curve
from ..regions import phase_of
from ..study import Study
from .colour import Colour, grid
from .experiment import detectable, separating
from .fit import Drop, DropFit, fit_drops
from .follow_up import follow_up
from .intervals import intervals
from .kept import kept
from .leftover import Leftover, repeating
from .recording import drop_of
from .search import EFFECT, LARGEST, DropSearch, air_lift, beside, equals, rivals, search

REMAINDER = 0.003  # a few parameters follow any smooth fall closely, so little has to be left
MOST = 0.5  # or of all that is left, this part, which repeats from drop to drop as no noise does
VISIBLE = 0.1  # of the floor, with ballast: then the same numbers have to hold for every mass, and less has to be left
SIGNIFICANT = 2e-3  # `unknown` below this p-value of what repeats
CLEAN = 0.05  # a set leaves nothing that repeats at or above it
NEAR = 12.0  # criterion within which another set is asked before `unknown` is said
TRANSFER = 3.0  # held-out energy over the worst fitted drop's from which on an explanation is asked if it holds there
TRANSFERRED = 0.06  # `unknown` above this part of the explainable held-out energy
CONFIDENCE = 0.8


class FallStudy(Study):
    """A dropped body: every small set of effects by forward simulation."""

    _rejected = ""  # what had been named before the held-out drops were seen to be worse with it

    @cached_property
    def drops(self) -> dict[str, Drop]:
        """All episodes."""
        self.mass, self.diameter = self.measured.number("mass"), self.measured.number("diameter")
        return {e.name: drop_of(self.measured, e) for e in self.measured.episodes}

    @property
    def fitted(self) -> list[Drop]:
        """Drops parameters may be fitted to."""
        return [self.drops[e.name] for e in self.measured.fitted]

    @property
    def heldout(self) -> list[Drop]:
        """Drops kept for the comparison."""
        return [self.drops[e.name] for e in self.measured.heldout]

    @cached_property
    def found(self) -> DropSearch:
        """All candidate sets, ranked."""
        return search(self.fitted, self.mass, self.diameter)

    @cached_property
    def chosen(self) -> DropFit:
        """The set that is believed: the best, or one that fits as well, with which held-out drops are no worse."""
        best = self._best
        for fit in (best, *(self.found.refit(c.fit.names, c.fit.mode) for c in rivals(self.found, best))):
            if self._holds(fit):
                return fit
        late = self._lateness(best)
        self._rejected = " and ".join([*best.names, *(["delay"] if late else [])])
        return self.found.refit((), self.found.given.mode)

    def _holds(self, fit: DropFit) -> bool:
        """Whether the held-out drops are no farther from the model with a set than from the model as given."""
        late = self._lateness(fit)
        if not fit.names and late is None:
            return fit is self._best
        before, after = (np.concatenate(f.residuals) for f in self._compared(fit, late))
        return _rms(after) <= _rms(before)

    @cached_property
    def _best(self) -> DropFit:
        """The best set, without effects the bootstrap over drops does not keep.

        Where it leaves a force that repeats from drop to drop, or takes more than two effects, a set that fits nearly
        as well without is taken instead: the registry is asked twice before `unknown` is said.
        """
        best = self.found.best
        fit = self.found.refit(best.names, best.mode)
        if best.names:
            kept = self._kept(fit)
            names = tuple(n for n in best.names if kept[n] >= CONFIDENCE)
            fit = fit if names == best.names else self.found.refit(names, best.mode)
        many = len(fit.names) + (fit.mode == "late") > LARGEST
        if not many and self._repeats(fit).p_value >= SIGNIFICANT:
            return fit
        for c in self.found.candidates:
            if c.score - self.found.candidates[0].score > NEAR:
                break
            if not 0 < len(c.effects) <= LARGEST:
                continue
            if (many or c.fit.names != fit.names) and self._repeats(c.fit).p_value >= CLEAN:
                return self.found.refit(c.fit.names, c.fit.mode)
        return fit

    def _repeats(self, fit: DropFit) -> Leftover:
        """What repeats in all drops; whether a set of effects is enough is asked of the held-out ones too."""
        # one fitted drop cannot tell a repeating force from slow noise, and a second one that is like it is one chance
        drops = self.fitted if len(self.fitted) < 2 else [*self.fitted, *self.heldout]
        asked = (fit.names, fit.mode)
        if asked not in self._asked:
            self._asked[asked] = repeating(fit_drops(drops, fit.names, fit.mode), drops)
        return self._asked[asked]

    @cached_property
    def _asked(self) -> dict[tuple[tuple[str, ...], str], Leftover]:
        """What repeats beside the sets asked so far."""
        return {}

    def _kept(self, fit: DropFit) -> dict[str, float]:
        return kept(self.found, fit, self.mass, self.diameter)

    @cached_property
    def late(self) -> tuple[float, float, float] | None:
        """A delay common to all drops: (seconds, low, high), where release instants agree better than by chance."""
        chosen = self.chosen
        return None if self._rejected else self._lateness(chosen)

    def _lateness(self, fit: DropFit) -> tuple[float, float, float] | None:
        instants = fit.releases[:, 1]
        if fit.mode == "together" or len(instants) < 3:
            return None
        step = float(np.median(np.diff(self.fitted[0].t)))
        low, high = (x[len(fit.theta) + len(instants) :] for x in self._ends(fit))
        own = 0.25 * (high - low)
        mean = float(instants.mean())
        if fit.mode == "free" and instants.std(ddof=1) > step + own.max():
            return None  # each drop was let go of when it was: a late reading is as late in all of them
        # each drop's own error is shared through the effects, so it does not shrink with the number of drops
        scatter = float(instants.var(ddof=1)) / len(instants) if fit.mode == "free" else 0.0
        error = float(np.sqrt(scatter + own.mean() ** 2))
        # where each drop was cut at a frame of its own, up to a frame of lateness is how it was cut
        if abs(mean) < (step if fit.mode == "free" else 0.02 * step) or abs(mean) < 3.0 * error:
            return None
        return mean, mean - 2.0 * error, mean + 2.0 * error

    def _interval(self, name: str, at: int, parameter: Parameter) -> tuple[float, float]:
        """95 % interval of one number, whichever of the sets that fit as well is the right one.

        Args:
            name: of its effect.
            at: where it is among the numbers of its effect.
            parameter: its bounds.
        """
        ends = []
        for fit in (self.chosen, *(c.fit for c in rivals(self.found, self.chosen))):
            mine = "quadratic_drag" if name == "wind" and "quadratic_drag" in fit.names else name
            if mine in fit.names:
                first = sum(len(BODY_EFFECTS[n].parameters) for n in fit.names[: fit.names.index(mine)])
                # quadratic drag is a wind of no speed
                ends.append([x[first + at] for x in self._ends(fit)] if mine == name or at == 0 else [0.0, 0.0])
        (low, _), (_, high) = np.min(ends, axis=0), np.max(ends, axis=0)
        return max(float(low), parameter.lower), min(float(high), parameter.upper)

    def _ends(self, fit: DropFit) -> tuple[np.ndarray, np.ndarray]:
        """Ends of the 95 % intervals of effects and releases (p,)."""
        if (fit.names, fit.mode) not in self._known:
            lift = air_lift(self.mass, self.diameter) if self.mass and self.diameter else 0.0
            self._known[fit.names, fit.mode] = intervals(fit, self._colours, self.fitted, lift)
        return self._known[fit.names, fit.mode]

    @cached_property
    def _known(self) -> dict[tuple[tuple[str, ...], str], tuple[np.ndarray, np.ndarray]]:
        """The intervals asked for so far."""
        return {}

    @cached_property
    def _colours(self) -> list[Colour]:
        """Of the noise, those worth trying."""
        return grid([d.t for d in self.fitted])

    @cached_property
    def leftover(self) -> Leftover:
        """What repeats from drop to drop after the effects."""
        return self._repeats(self.chosen)

    @cached_property
    def verdict(self) -> VerdictName:
        """One of the four."""
        energy = self.leftover.energy
        explained = max(_squares(self.found.given) - _squares(self.chosen), 0.0) / self.found.rows
        much = energy / (energy + explained + 1e-30) > REMAINDER
        if any(d.factor != 1.0 for d in self.fitted):
            much = energy > (VISIBLE * self.found.floor) ** 2
        much = much or energy > MOST * _squares(self.chosen) / self.found.rows
        if self.leftover.p_value < SIGNIFICANT and much:
            return "unknown"
        if self._strange > TRANSFERRED or self._many or self._rejected:
            return "unknown"
        return "effects" if self.chosen.names or self.late else "adequate"

    @property
    def _many(self) -> bool:
        """Whether it would take more effects at once than drops can tell from any other smooth force."""
        return len(self.chosen.names) + (self.late is not None) > LARGEST

    @cached_property
    def _strange(self) -> float:
        """Part of the explainable held-out energy left there, where far more is left than in any fitted drop."""
        if not self.chosen.names:
            return 0.0
        before, after = (np.concatenate(f.residuals) for f in self._compared())
        given, left = float(np.mean(before**2)), float(np.mean(after**2))
        usual = max(float(np.mean(r**2)) for r in self.chosen.residuals)
        if left < TRANSFER * usual:
            return 0.0
        return (left - usual) / (left - usual + max(given - left, 0.0))

    def find(self) -> tuple[float, str, tuple[Where, ...]]:
        """See `Study.find`."""
        none = (
            min(
                (c for c in self.found.candidates if not c.fit.names and c.fit.mode == "together"),
                key=lambda c: c.score,
            ).fit
            if self.late
            else self.found.given
        )
        p = min(
            1.0,
            min(
                15.0 * float(chi2.sf(self.found.worth * np.log(none.rss / max(c.fit.rss, 1e-12)), len(c.fit.theta)))
                for c in self.found.candidates
                if c.fit.names
            ),
        )
        if self.verdict == "adequate":
            p = max(p, self.alpha)
        elif self.verdict == "unknown":
            p = min(p, self.leftover.p_value)
        places = []
        if self.verdict != "adequate":
            phases = {e.name: e.phases for e in self.measured.episodes}
            for d, r, (_, start) in zip(self.fitted, none.residuals, none.releases, strict=True):
                late = d.t >= max(start, 0.0)
                places.append(
                    Where(
                        channel="h",
                        target="body",
                        episode=d.name,
                        t0=float(max(start, 0.0)),
                        t1=float(d.t[-1]),
                        state_region="high speed",
                        p_value=p,
                        phase=phase_of(phases[d.name], float(start), float(d.t[-1])),
                        size=float(np.sqrt(np.mean(r[late] ** 2)) / self.found.floor),
                        effect=self.chosen.names[0] if self.chosen.names else "",
                    )
                )
        return p, "residual", tuple(places)

    def name(self) -> tuple[VerdictName, tuple[EffectFinding, ...], tuple[EffectFinding, ...], str]:
        """See `Study.name`."""
        kept = self._kept(self.chosen)
        out, at = [], 0
        for name in self.chosen.names:
            effect = BODY_EFFECTS[name]
            values = []
            for k, p in enumerate(effect.parameters):
                low, high = self._interval(name, k, p)
                values.append(Value(name=p.name, unit=p.unit, value=float(self.chosen.theta[at]), low=low, high=high))
                at += 1
            if self.mass and effect.per_mass:
                first = values[0]
                values.append(
                    Value(
                        name="coefficient_with_mass",
                        unit=effect.usual_unit,
                        value=first.value * self.mass,
                        low=first.low * self.mass,
                        high=first.high * self.mass,
                    )
                )
            others = equals(self.found, name, self.chosen)
            without = self.found.refit(tuple(n for n in self.chosen.names if n != name), self.chosen.mode)
            own = np.sqrt(max(_squares(without) - _squares(self.chosen), 0.0) / self.found.rows)
            gained = self.found.worth * np.log(without.rss / self.chosen.rss)
            smallest = np.sqrt((EFFECT + self.found.price * len(effect.parameters)) / max(gained, 1e-9))
            out.append(
                EffectFinding(
                    name=name,
                    target="body",
                    parameters=tuple(values),
                    confidence=kept[name],
                    equivalent=tuple(n for n, _ in others),
                    size=float(own / self.found.floor),
                    smallest=float(smallest) if values[0].value else float("nan"),
                    experiment=separating(self.fitted, self.chosen, others[0], self.found.floor) if others else "",
                )
            )
        if self.late:
            mean = self.late[0]
            if mean > 0.0:
                self.notes.append("Logs that all begin so long before the release look just as such a delay does.")
            same = (self._lateness(c.fit) for c in rivals(self.found, self.chosen) if c.fit.mode == "late")
            low, high = np.array([self.late, *(x for x in same if x)])[:, 1:].T
            out.append(
                EffectFinding(
                    name="delay",
                    target="body",
                    size=float("nan"),
                    parameters=(
                        Value(name="time", unit="s", value=mean, low=float(low.min()), high=float(high.max())),
                    ),
                    equivalent=tuple(n for n, _ in equals(self.found, "delay", self.chosen)),
                )
            )
        names = {f.name for f in out}
        if names & {"linear_drag", "quadratic_drag"} and any("drag" in n for f in out for n in f.equivalent):
            self.notes.append(
                "Over one range of speeds linear and quadratic drag look alike; which fits better here says "
                "little about which acts."
            )
        return self.verdict, tuple(out), (), self._guess()

    def _guess(self) -> str:
        """What is missing where the verdict is `unknown`, as far as can be said; else nothing."""
        if self.verdict != "unknown":
            return ""
        if self._rejected:
            return f"{self._rejected} would explain the fitted drops and make the held-out ones worse"
        if self._strange > TRANSFERRED:
            return "the effects that explain the fitted drops do not hold on the held-out ones"
        if self._many and self.leftover.p_value >= SIGNIFICANT:
            return "a smooth force that only three effects of the registry together can follow, as they follow any"
        return f"{self.leftover.what}, {np.sqrt(self.leftover.energy):.3g} m root mean square"

    def rivals(self) -> tuple[Rival, ...]:
        """See `Study.rivals`."""
        if self.verdict != "effects":
            return ()
        return tuple(
            Rival(
                effects=tuple((n, "body") for n in sorted(c.effects)),
                experiment=separating(
                    self.fitted, self.chosen, (" + ".join(sorted(c.effects)), c.fit), self.found.floor
                ),
            )
            for c in (*rivals(self.found, self.chosen), *beside(self.found, self.chosen))
        )

    def follow_up(self) -> tuple[FollowUp, ...]:
        """See `Study.follow_up`."""
        if self.verdict == "adequate":
            return ()
        return follow_up(self.found, self.chosen, [c.fit for c in rivals(self.found, self.chosen)])

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        effects = [{"name": n, "target": "body", "parameters": dict(v)} for n, v in self.chosen.values.items()]
        if self.late:
            effects.append({"name": "delay", "target": "body", "parameters": {"time": self.late[0]}})
        return {"system": "fall", "mass": self.mass, "recalibration": [], "effects": effects}

    def show(self) -> tuple[Gap, Gap | None, tuple[Placebo, ...], dict[str, str]]:
        """See `Study.show`."""
        before, after = self._compared()
        b, a = np.concatenate(before.residuals), np.concatenate(after.residuals)
        rows = [
            (np.sum(x**2), np.sum(y**2))
            for p, q in zip(before.residuals, after.residuals, strict=True)
            for x, y in zip(np.array_split(p, 5), np.array_split(q, 5), strict=True)
        ]
        table, rng = np.array(rows), np.random.default_rng(0)
        ratio = [
            np.sqrt(s[1] / max(s[0], 1e-30))
            for s in (table[rng.integers(len(table), size=len(table))].sum(axis=0) for _ in range(300))
        ]
        low, high = np.quantile(ratio, [0.025, 0.975])
        floor = float(min(self.found.floor, _rms(a)))
        gap = Gap(
            unit="m",
            floor=floor,
            before=_rms(b),
            after=_rms(a),
            low=float(low),
            high=float(high),
            channels={"h": {"floor": floor, "before": _rms(b), "after": _rms(a)}},
        )
        controls = []
        if self.chosen.names:
            wrong = np.array([-0.5 * x for x in self.chosen.theta])
            turned = fit_drops(
                self.heldout, self.chosen.names, after.mode, start=wrong, late=self.late[0] if self.late else None
            )
            controls.append(
                Placebo(
                    what=f"{' + '.join(self.chosen.names)} half the size, wrong sign, against the model as given",
                    ratio=_rms(np.concatenate(turned.residuals)) / max(_rms(b), 1e-12),
                )
            )
        return gap, None, tuple(controls), detectable(self.found, self.chosen)

    def _compared(
        self, fit: DropFit | None = None, late: tuple[float, float, float] | None = None
    ) -> tuple[DropFit, DropFit]:
        """Held-out drops under the model as given and with a fit, else the chosen one; releases are each drop's own."""
        if fit is None:
            fit, late = self.chosen, self.late
        when = late[0] if late else None
        mode = "late" if when is not None else fit.mode
        given = self.found.given.mode if when is None else "together"
        return (
            fit_drops(self.heldout, (), given),
            fit_drops(self.heldout, fit.names, mode, start=fit.theta, late=when),
        )

    def curves(self) -> list[Curve]:
        """Held-out drops."""
        before, after = self._compared()
        return [
            Curve(
                title=f"height, held-out {d.name}",
                unit="m",
                t=d.t,
                measured=d.h,
                before=d.h - x,
                after=d.h - y,
                floor=self.found.floor,
            )
            for d, x, y in list(zip(self.heldout, before.residuals, after.residuals, strict=True))[:3]
        ]


def _rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))


def _squares(fit: DropFit) -> float:
    """Residual sum of squares [m^2], not whitened."""
    return float(sum(np.sum(r**2) for r in fit.residuals))

"""The four steps for a simulator of one's own: the search, tests and rules are those of joints."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import GapError
from ..findings import EffectFinding, Gap, Placebo, VerdictName, Where, told_apart
from ..joints.bootstrap import kept_part
from ..joints.detect import smallest_found
from ..joints.heldout_gap import gap_of
from ..joints.intervals import intervals, value_within
from ..joints.localise import places
from ..joints.log import JointLog
from ..joints.outcome import Outcome, farther, inadequacy, judge
from ..joints.placebo import shifted
from ..measurement import MeasurementSet, require_columns
from ..pictures import Curve
from ..study import Study
from .equals import equals, separating
from .model_error import SURE, deviations, size_in_errors
from .naming import Found, name_own, none_of, without
from .simulation import Recording, Simulation, recording
from .system import System

BORNE_OUT = 0.2  # part of what a set leaves held out that is left beside it without one of its effects, at least
FLOORS = "noise floors"  # the unit of a gap over channels of several units


class OwnStudy(Study):
    """A user's simulator: residuals of its prediction, columns by derivative or as the user gives them."""

    def __init__(self, measured: MeasurementSet, alpha: float, system: System, source: str) -> None:
        super().__init__(measured, alpha)
        self.system, self.source = system, source
        for episode in measured.episodes:
            require_columns(episode, [*system.channels, *system.inputs])

    @cached_property
    def _recordings(self) -> tuple[list[Recording], list[Recording]]:
        """To fit, and held out."""
        made = ([recording(e, self.system) for e in group] for group in (self.measured.fitted, self.measured.heldout))
        fitted, heldout = made
        return fitted, heldout

    @cached_property
    def sim(self) -> Simulation:
        """The system on the recordings to fit.

        Raises:
            GapError: asked twice, it does not give the same answer.
        """
        sim = Simulation(self.system, self._recordings[0])
        if not sim.repeats():
            raise GapError(f"{type(self.system).__name__}.predict gives two answers to one question, it must repeat")
        return sim

    @cached_property
    def _searched(self) -> tuple[Found, str]:
        """The search's result, and what it had named where that made the held-out recordings worse."""
        return self._held_to(name_own(self.sim))

    def _held_to(self, found: Found) -> tuple[Found, str]:
        """What the held-out recordings leave of a search's result, and what they were worse with."""
        if self.sim.model_error.any():
            found = self._borne_out(found)
        if found.named.blocks and farther(*self._before_and_after(found), found.named.noise.rms / self.sim.scale):
            worse = " and ".join(f"{b.name} on {b.target}" for b in found.named.blocks)
            return none_of(found, self.sim), worse
        return found, ""

    def _borne_out(self, found: Found) -> Found:
        """Those effects that the held-out recordings bear out, where the model errs by itself.

        Its error is now and then several times as large as usual, and few recordings to fit take one such for an
        effect.  What none of those held out could show, such as a bias of a hand that they do not use, is given up too.
        """
        while found.effects:
            left = self._left_of_heldout(found)
            fewer = [without(found, self.sim, k) for k in range(len(found.effects))]
            best = min(fewer, key=self._left_of_heldout)
            if self._left_of_heldout(best) > (1.0 + BORNE_OUT) * left:
                return found
            found = best
        return found

    def _left_of_heldout(self, found: Found) -> float:
        """Mean square that a set leaves of the held-out recordings, each channel over the model's own error.

        Over its gap, a channel that nothing changes would count as much as those that an effect closes.
        """
        error = np.where(self.sim.model_error > 0.0, self.sim.model_error, self.sim.scale)
        left = np.concatenate(self._before_and_after(found)[1]) * self.sim.scale / error
        return float(np.mean(left**2))

    @property
    def found(self) -> Found:
        """The search's result; nothing where the held-out recordings are worse with it."""
        return self._searched[0]

    def _before_and_after(self, found: Found) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """What the model as given and the one with the effects leave of the held-out recordings, over the scale."""
        before, after = (
            [self.sim.left(r, values) / self.sim.scale for r in self._recordings[1]]
            for values in (self.sim.none, found.point.values)
        )
        return before, after

    @cached_property
    def _heldout(self) -> list[JointLog]:
        return [self.found.point.log(r) for r in self._recordings[1]]

    @cached_property
    def outcome(self) -> Outcome:
        """What the search's result amounts to, after a look at what it leaves."""
        found, worse = self._searched
        channels = tuple(self.system.channels)
        units = ", ".join(dict.fromkeys(self.system.channels.values()))
        out = judge(found.named, found.point.logs, self._heldout, channels, units, worse, self.sim.model_error)
        if out.bursts and not worse:  # a contact is no effect of this class, so nothing here can be named for it
            b = out.bursts[0]
            text = (
                f"a burst in {channels[b.channel]} from {b.t0:.3g} to {b.t1:.3g} s of {b.episode} that no effect makes"
            )
            out = replace(out, verdict="unknown", contacts=(), guess=text)
        if out.guess and not worse:
            self.notes.append("In the guess q, v and a are the predicted channel and its rates, u is the command.")
        return out

    @cached_property
    def kept(self) -> np.ndarray:
        """Part of the resamples that keeps each effect, (B,)."""
        return kept_part(self.found.named.search, self.found.named.chosen, self.found.point.logs)

    @cached_property
    def half_widths(self) -> np.ndarray:
        """Half-widths of the parameters' 95 % intervals, (k,)."""
        n, logs = self.found.named, self.found.point.logs
        own = intervals(n.blocks, n.theta, n.search.weight, logs).linear
        return np.hypot(own, SURE * deviations(n.blocks, n.search.weight, logs, self.sim.model_error))

    def find(self) -> tuple[float, str, tuple[Where, ...]]:
        """See `Study.find`."""
        named, channels = self.found.named, tuple(self.system.channels)
        logs = [*self.found.point.logs, *self._heldout]
        where = places(self.measured, channels, logs, named, self.outcome, channels)
        return inadequacy(named, self.outcome, self.alpha), named.noise.source, tuple(where)

    def name(self) -> tuple[VerdictName, tuple[EffectFinding, ...], tuple[EffectFinding, ...], str]:
        """See `Study.name`."""
        findings = self._findings
        own = [e.recalibration for e in self.found.effects]
        effects = tuple(f for f, recalibration in zip(findings, own, strict=True) if not recalibration)
        changed = tuple(f for f, recalibration in zip(findings, own, strict=True) if recalibration)
        return self.outcome.verdict, effects, changed, self.outcome.guess

    @cached_property
    def _findings(self) -> tuple[EffectFinding, ...]:
        out, at = [], 0
        for k, effect in enumerate(self.found.effects):
            span = slice(at, at + len(effect.parameters))
            out.append(self._finding(k, span))
            at = span.stop
        return tuple(out)

    def _finding(self, k: int, span: slice) -> EffectFinding:
        named, effect = self.found.named, self.found.effects[k]
        block, theta = named.blocks[k], named.theta[span]
        values = tuple(
            value_within(p, p.unit, v, v - h, v + h)
            for p, v, h in zip(effect.parameters, theta, self.half_widths[span], strict=True)
        )
        others = equals(self.sim, self.found, k)
        experiment = ""
        if others:
            text, apart = separating(self.sim, self.found, others[0], self.outcome.floor)
            experiment = told_apart(text, effect.name, " + ".join(others[0].names), apart)
        moved = np.concatenate([block.build(log) @ theta for log in self.found.point.logs])
        return EffectFinding(
            name=effect.name,
            target=effect.target,
            parameters=values,
            equivalent=tuple(" + ".join(e.names) for e in others),
            experiment=experiment,
            size=float(np.max(np.sqrt(np.mean(moved**2, axis=0)) / self.outcome.floor)),
            smallest=self._smallest(named.chosen[k], theta),
            confidence=float(self.kept[k]),
        )

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        effects, recalibration = [], []
        for e in self.found.effects:
            values = {p.name: self.found.point.values[p.name] for p in e.parameters}
            (recalibration if e.recalibration else effects).append(
                {"name": e.name, "target": e.target, "parameters": values}
            )
        base = {"system": self.system.name, "simulator": self.source}
        return {**base, "recalibration": recalibration, "effects": effects}

    def show(self) -> tuple[Gap, Gap | None, tuple[Placebo, ...], dict[str, str]]:
        """See `Study.show`."""
        before, after = self._before_and_after(self.found)
        unit, factor = self._shown_in
        gap = gap_of(
            [x * factor for x in before],
            [x * factor for x in after],
            self.outcome.floor / self.sim.scale * factor,
            tuple(self.system.channels),
            unit,
        )
        named = self.found.named
        controls = (shifted(named, named.blocks[0], self.found.point.logs, self._heldout),) if named.blocks else ()
        return gap, None, controls, self._detectable()

    @property
    def _shown_in(self) -> tuple[str, np.ndarray]:
        """Unit of the gap, and (C,) what one scale of each channel is in it."""
        units = set(self.system.channels.values())
        if len(units) == 1:
            return units.pop(), self.sim.scale
        return FLOORS, self.sim.scale / self.outcome.floor

    def _detectable(self) -> dict[str, str]:
        """Smallest size of every effect that was not found which these recordings could have shown."""
        out: dict[str, str] = {}
        search, chosen = self.found.named.search, self.found.named.chosen
        found = {b.key for b in self.found.named.blocks}
        for i, block in enumerate(search.blocks):
            if block.key in found or search.clash(i, chosen):
                continue
            p = block.parameters[0]
            unit = np.zeros(len(block.parameters))
            unit[0] = p.typical if p.upper > 0.0 else -p.typical
            factor = self._smallest(i, unit)
            least = factor * p.typical if np.isfinite(factor) else 4.0 * p.typical
            out[f"{block.name} on {block.target}"] = f"{'' if np.isfinite(factor) else 'not even '}{least:.3g} {p.unit}"
        return out

    def _smallest(self, i: int, theta: np.ndarray) -> float:
        """Part of `theta` (p,) of block `i` that would have been named: above the noise, and the model's own error."""
        search = self.found.named.search
        size = size_in_errors(search.blocks[i], theta, self.found.point.logs, self.sim.model_error)
        seen = smallest_found(search, self.found.named.chosen, i, theta)
        return max(seen, 1.0 / size) if size > 0.0 else seen

    def curves(self) -> list[Curve]:
        """The channels with the largest gap, on the first held-out recording."""
        r = self._recordings[1][0]
        before, after = (self.sim.predict(r, values) for values in (self.sim.none, self.found.point.values))
        order = np.argsort(-np.sqrt(np.mean((r.measured - before) ** 2, axis=0)) / self.outcome.floor)[:3]
        where, out = self.find()[2], []
        for c in sorted(order):
            channel = list(self.system.channels)[c]
            spans = tuple(
                (w.t0, w.t1)
                for w in where
                if (w.channel, w.episode) == (channel, r.episode.name) and w.t1 - w.t0 < 0.8 * (r.t[-1] - r.t[0])
            )
            out.append(
                Curve(
                    title=f"{channel}, held-out {r.episode.name}",
                    unit=self.system.channels[channel],
                    t=r.t,
                    measured=r.measured[:, c],
                    before=before[:, c],
                    after=after[:, c],
                    floor=float(self.outcome.floor[c]),
                    spans=spans,
                )
            )
        return out

"""The four steps for an axis or an arm."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..findings import Change, EffectFinding, Gap, Placebo, Rival, VerdictName, Where, told_apart
from ..pictures import Curve
from ..study import Study
from .alternatives import alternatives, best_experiment, experiments, mass_twins
from .arm_model import ArmModel
from .axis_model import AxisModel
from .block import Block
from .bootstrap import confident, kept_part
from .detect import smallest_found
from .doubts import doubts
from .gram import assemble
from .heldout_gap import gap_of
from .intervals import Intervals, intervals, value_within
from .localise import places
from .log import JointLog, read_logs
from .opening import check_load, columns_of, rigid_model
from .outcome import MET_ONCE, Outcome, farther, inadequacy, judge, louder, makes_worse, unexplained
from .payloads.carried import Fit, carried_at_first, changes_of, told_in
from .payloads.solid import with_solid_body
from .placebo import placebos
from .remains.steadiness import unsteady
from .rests import has_dry_friction, left_out, moving
from .rigid import RigidModel
from .rivals import Unsearched, beside, determined, parting, rivals
from .rollout import acting, patched_joints, rollout_gap
from .search import Search
from .workflow import Named, explained, name_effects

SHARED_OUT = "beside another effect that fits as well, any part of it may be that one's"
MOST_BESIDE = 3  # effects told that could act beside the named ones unseen


class JointStudy(Study):
    """An axis or an arm: inverse dynamics residuals, regressors, and short forward rollouts."""

    @cached_property
    def _logs(self) -> tuple[RigidModel, list[JointLog]]:
        columns = columns_of(self.measured)
        model = rigid_model(self.measured, len(columns.q))
        check_load(self.measured, columns, model)
        logs = read_logs(list(self.measured.episodes), columns, model)
        if isinstance(model, AxisModel) and not model.mass_known:
            model = AxisModel(_start_mass(_but_held_out(logs)))
            self.notes.append(
                f"No mass was given; {model.mass:.4g} kg fits this log best and stands for the model's own."
            )
            logs = read_logs(list(self.measured.episodes), columns, model)
        return model, logs

    @property
    def model(self) -> RigidModel:
        """The model as given."""
        return self._logs[0]

    @property
    def fitted(self) -> list[JointLog]:
        """Logs that parameters may be fitted to."""
        return _but_held_out(self._used[0])

    @property
    def heldout(self) -> list[JointLog]:
        """Logs kept for the comparison."""
        return [log for log in self._used[0] if log.role == "heldout"]

    @cached_property
    def _used(self) -> tuple[list[JointLog], Named]:
        """The logs, without rests where what moves has dry friction, and what the search names."""
        model, logs = self._logs
        lost, odd = left_out(logs), ", ".join(logs[0].odd_speeds)
        if odd:
            self.notes.append(f"Not used as speed, as it is late against the slope of the position, or off it: {odd}.")
        if lost:
            self.notes.append(f"{lost:.3g} s in which a load stands still or is cut off are left out.")
        moved = [moving(log) for log in logs]
        if any(m is not log for m, log in zip(moved, logs, strict=True)):
            named = name_effects(model, _but_held_out(moved), self.measured.system)
            if has_dry_friction(named.blocks):
                self.notes.append(
                    f"{left_out(moved) - lost:.3g} s in which nothing moves are left out: dry friction may be anything "
                    "up to its level there."
                )
                return moved, named
        return logs, name_effects(model, _but_held_out(logs), self.measured.system)

    @property
    def channels(self) -> tuple[str, ...]:
        """Load columns, one per joint."""
        return columns_of(self.measured).load

    @property
    def unit(self) -> str:
        """Unit of the loads."""
        return "N" if all(self.model.prismatic) else "N m"

    @cached_property
    def _searched(self) -> tuple[Named, str]:
        """The search's result, and what it had named where that made the held-out logs worse and was given up."""
        named = confident(self._used[1], self.fitted)
        constant = named.constant
        if named.carried and constant:
            fit = Fit(blocks=named.blocks, theta=named.theta, weight=named.search.weight, model=self.model)
            known, blocks = told_in(named.carried, fit, self.heldout)
            named = replace(named, carried=known, blocks=blocks)
            constant = confident(constant, self.fitted)
            before, after = (unexplained(n, self.heldout) for n in (constant, named))
            worse = farther(before, after, named.noise.rms) and louder(after, unexplained(named, self.fitted))
            named = constant if worse else named
        if not named.chosen or not makes_worse(named, self.heldout):
            return named, ""
        worse = " and ".join(f"{b.name} on {b.target}" for b in named.blocks) if self._pays(named) else ""
        return replace(named, blocks=(), chosen=(), theta=np.zeros(0)), worse

    def _pays(self, named: Named) -> bool:
        """Whether effects pay their price over all logs, or on those held out alone with numbers of their own.

        What does neither was chance in those fitted, and nothing is missing for it.
        """
        whole, price = tuple(range(len(named.blocks))), float(named.search.price[list(named.chosen)].sum())
        for logs in (self._used[0], self.heldout):
            search = Search(gram=assemble(list(named.blocks), logs), noise=named.noise)
            if search.rows @ (np.log(search.rss(())) - np.log(search.rss(whole))) > price:
                return True
        return False

    @property
    def named(self) -> Named:
        """The search's result; nothing where the held-out logs are worse with it."""
        return self._searched[0]

    @cached_property
    def outcome(self) -> Outcome:
        """What the search's result amounts to, after a look at what it leaves."""
        return judge(
            self.named,
            self.fitted,
            self.heldout,
            self.model.joints,
            self.unit,
            self._searched[1],
            doubts=doubts(self.model, self.fitted, self.channels),
            unsteady=unsteady(self.named, self.fitted),
        )

    @cached_property
    def kept(self) -> np.ndarray:
        """Part of the resamples that keeps each effect, (B,)."""
        return kept_part(self.named.search, self.named.chosen, self.fitted)

    @cached_property
    def intervals(self) -> Intervals:
        """How sure the numbers are."""
        n = self.named
        ridge = n.search.ridge[n.search.columns(n.chosen)]
        return intervals(n.blocks, n.theta, n.search.weight, self.fitted, self.model, ridge)

    def find(self) -> tuple[float, str, tuple[Where, ...]]:
        """See `Study.find`."""
        return (
            inadequacy(self.named, self.outcome, self.alpha),
            self.named.noise.source,
            tuple(places(self.measured, self.model.joints, self._used[0], self.named, self.outcome, self.channels)),
        )

    def name(self) -> tuple[VerdictName, tuple[EffectFinding, ...], tuple[EffectFinding, ...], str]:
        """See `Study.name`."""
        effects, recalibration = [], []
        at = 0
        for k, block in enumerate(self.named.blocks):
            n = len(block.parameters)
            theta = self.named.theta[at : at + n]
            finding = self._finding(k, block, theta, slice(at, at + n))
            at += n
            (recalibration if block.recalibration else effects).append(finding)
        for event in self.outcome.contacts:
            effects.append(event)
        return self.outcome.verdict, tuple(effects), tuple(recalibration), self._guess

    def _finding(self, k: int, block: Block, theta: np.ndarray, span: slice) -> EffectFinding:
        prismatic = self.model.prismatic[block.channels[0]]
        low, high, told = self._ends(k, theta, self.intervals.linear[span])
        values = [
            value_within(p, p.unit_for(prismatic), v, a, b, "" if sure else SHARED_OUT)
            for p, v, a, b, sure in zip(block.parameters, theta, low, high, told, strict=True)
        ]
        if block.term is None:
            values += [
                value_within(p, p.unit_for(prismatic), x := block.shape[p.name], x - h, x + h)
                for p, h in ((p, self.intervals.shape.get((k, p.name), 0.0)) for p in block.shape_parameters)
            ]
        search, chosen = self.named.search, self.named.chosen
        others = alternatives(search, chosen, chosen[k])
        experiment = ""
        if others:
            text, apart = best_experiment(block, theta, others[0], self._motions, self.fitted, self.named.noise.rms)
            experiment = told_apart(text, block.name, " + ".join(others[0].names), apart)
        loads = np.concatenate([block.build(log) @ theta for log in self.fitted])
        size = float(np.max(np.sqrt(np.mean(loads**2, axis=0)) / self.named.noise.rms[list(block.channels)]))
        smallest = smallest_found(search, chosen, chosen[k], theta)
        return EffectFinding(
            name=block.name,
            target=block.body,
            parameters=tuple(values),
            experiment=experiment,
            when=self._when(block),
            equivalent=(*(" + ".join(a.names) for a in others), *mass_twins(block)),
            size=size,
            smallest=smallest,
            confidence=float(self.kept[k]),
        )

    def _when(self, block: Block) -> tuple[tuple[str, float, float], ...]:
        """In which stretches of which recordings it acts; () for all."""
        if block.term is None or block.term.during is None:
            return ()
        during, ends = block.term.during, {log.name: log.t[[0, -1]] for log in self._used[0]}
        return tuple(
            (name, float(max(a, start)), float(min(b, stop)))
            for name, (start, stop) in ends.items()
            for a, b in during.of(name)
        )

    def changes(self) -> tuple[Change, ...]:
        """See `Study.changes`."""
        n = self._everywhere or self.named
        return tuple(changes_of(n.carried, n.blocks, n.theta, [x.name for x in self._used[0]])) if n.carried else ()

    @cached_property
    def _everywhere(self) -> Named | None:
        """What a search of all logs says, where it says that a payload changes and that of the fitted ones does not.

        It tells why effects do not hold on logs held out; nothing of it is added to the model.
        """
        if self.outcome.verdict != "unknown" or self.named.carried:
            return None
        named = name_effects(self.model, [*self.fitted, *self.heldout], self.measured.system)
        return named if named.carried else None

    @property
    def _guess(self) -> str:
        """What is missing, where it has no name, or why what has one does not hold."""
        n = self._everywhere
        if n is None or n.carried is None:
            return self.outcome.guess
        told = [f"{c.before:.2f} to {c.after:.2f} kg at {c.t:.1f} s of {c.episode}" for c in self.changes()]
        if not told:
            begun = carried_at_first(n.carried, n.blocks, n.theta, [x.name for x in self._used[0]])
            told = [f"{mass:.2f} kg in {name}" for name, mass in begun]
        return f"the payload is not the same all the time ({', '.join(told)}); fit to recordings that have all of it"

    def rivals(self) -> tuple[Rival, ...]:
        """See `Study.rivals`."""
        if self.outcome.verdict != "effects" or not self.named.chosen:
            return ()
        search, chosen, floor = self.named.search, self.named.chosen, self.named.noise.rms
        # a burst was met once, and beside an effect it may be no more than that one's form being a little wrong
        bursts = tuple((e.name, e.target) for e in self.outcome.contacts)
        named = tuple(b.key for b in self.named.blocks if not b.recalibration)
        out = [Rival(effects=named, experiment=MET_ONCE)] if bursts and named else []
        pairs = [(search, chosen, o) for o in (*self._rival_sets, *beside(search, chosen, most=MOST_BESIDE))]
        if isinstance(self.model, ArmModel):
            pairs = [*with_solid_body(search, chosen, self.model, self.fitted), *pairs]
        for inside, first, other in pairs:
            blocks = [inside.blocks[i] for i in other if not inside.blocks[i].recalibration]
            text, apart = parting(inside, first, other, self._motions, floor)
            name = " + ".join(b.name for b in self.named.blocks)
            names = " + ".join(b.name for b in blocks)
            keys = tuple(dict.fromkeys([*(b.key for b in blocks), *bursts]))
            if keys and frozenset(keys) not in {frozenset(r.effects) for r in out}:
                out.append(Rival(effects=keys, experiment=told_apart(text, name, names, apart)))
        return tuple(out)

    @cached_property
    def _rival_sets(self) -> list[tuple[int, ...]]:
        """Other sets of the search's blocks that fit as well."""
        n = self.named
        return rivals(n.search, n.chosen, Unsearched(n.search, self.heldout))

    @cached_property
    def _motions(self) -> dict[str, JointLog]:
        """What could be run next."""
        return experiments(self.model, self.fitted[0])

    def _ends(self, k: int, theta: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ends of the intervals of the `k`-th block's numbers, whichever of the sets that fit as well is right.

        Returns:
            (lower ends, upper ends, whether every such set tells the number).
        """
        search, index = self.named.search, self.named.chosen[k]
        every, told = [theta], np.ones(len(theta), dtype=bool)
        for other in self._rival_sets:
            if index in other:
                at = len(search.columns(other[: other.index(index)]))
                mine = slice(at, at + len(theta))
                known = determined(search, other)[mine]
                every.append(np.where(known, search.fit(other)[mine], theta))
                told &= known
        return np.min(every, axis=0) - half, np.max(every, axis=0) + half, told

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        effects, recalibration = [], []
        at = 0
        for block in self.named.blocks:
            n = len(block.parameters)
            if block.term is not None and block.term.during is not None and not block.term.during.last:
                at += n  # what was put down or exchanged since is no part of the arm any more
                continue
            values = {p.name: float(v) for p, v in zip(block.parameters, self.named.theta[at : at + n], strict=True)}
            at += n
            if block.term is not None and not block.recalibration:
                values = self.model.moments(block.term, values)
            elif block.term is None:
                values |= block.shape
            entry = {"name": block.name, "target": block.body, "parameters": {k: float(v) for k, v in values.items()}}
            (recalibration if block.recalibration else effects).append(entry)
        base: dict[str, Any] = {"system": self.measured.system}
        if isinstance(self.model, AxisModel):
            base["mass"] = self.model.mass
        else:
            base["robot"] = self.measured.settings["robot"]
        return {**base, "recalibration": recalibration, "effects": effects}

    def show(self) -> tuple[Gap, Gap | None, tuple[Placebo, ...], dict[str, str]]:
        """See `Study.show`."""
        blocks, theta = list(self.named.blocks), self.named.theta
        before = [log.residual[log.inner] for log in self.heldout]
        after = [y - explained(blocks, theta, log) for y, log in zip(before, self.heldout, strict=True)]
        floor = self.outcome.floor
        gap = gap_of(before, after, floor, self.channels, self.unit)
        forward = None
        if blocks:
            given = patched_joints(self.model, (), np.zeros(0), self.heldout[0].slow)
            pairs = [
                (
                    rollout_gap(given, log),
                    rollout_gap(patched_joints(self.model, *acting(blocks, theta, log), log.slow), log),
                )
                for log in self.heldout[:3]
            ]
            b, a = (np.sqrt(np.mean([p[i] ** 2 for p in pairs], axis=0)) for i in (0, 1))
            forward = Gap(
                unit="m" if all(self.model.prismatic) else "rad",
                floor=0.0,
                before=float(np.sqrt(np.mean(b**2))),
                after=float(np.sqrt(np.mean(a**2))),
                low=float("nan"),
                high=float("nan"),
                channels={
                    j: {"floor": 0.0, "before": float(x), "after": float(y)}
                    for j, x, y in zip(columns_of(self.measured).q, b, a, strict=True)
                },
            )
        controls = placebos(self.named, self.model, self.fitted, self.heldout) if blocks else ()
        return gap, forward, controls, self._detectable()

    def _detectable(self) -> dict[str, str]:
        """Smallest size of common effects this log could have shown, per joint, for those not found."""
        out: dict[str, str] = {}
        search, chosen = self.named.search, self.named.chosen
        wanted = ("viscous_friction", "coulomb_friction", "offset", "payload", "gain_error")
        found = {b.key for b in self.named.blocks}
        for i, block in enumerate(search.blocks):
            if block.name not in wanted or block.key in found or len(out) >= 40 or search.clash(i, chosen):
                continue
            if set(block.channels) & set(range(len(self.channels))) and len(chosen) < 30:
                unit = np.zeros(len(block.parameters))
                energy = np.mean([np.mean(block.build(log)[:, :, 0] ** 2) for log in self.fitted])
                unit[0] = float(np.mean(self.named.noise.rms[list(block.channels)]) / np.sqrt(energy + 1e-30))
                factor = smallest_found(search, chosen, i, unit)
                p = block.parameters[0]
                out[f"{block.name} on {block.target}"] = (
                    f"{factor * unit[0]:.3g} {p.unit_for(self.model.prismatic[block.channels[0]])}"
                    if np.isfinite(factor)
                    else f"not even {4 * unit[0]:.3g} {p.unit_for(self.model.prismatic[block.channels[0]])}"
                )
        return out

    def curves(self) -> list[Curve]:
        """The channels with the largest gap, on the first held-out episode."""
        log = self.heldout[0]
        change = explained(list(self.named.blocks), self.named.theta, log)
        residual = log.residual[log.inner]
        order = np.argsort(-np.sqrt(np.mean(residual**2, axis=0)) / self.outcome.floor)[:3]
        measured = log.shared(log.measured)
        where = self.find()[2]
        out = []
        for c in sorted(order):
            spans = tuple(
                (w.t0, w.t1)
                for w in where
                if w.channel == self.channels[c]
                and w.episode == log.name
                and (w.t1 - w.t0) < 0.8 * (log.t[-1] - log.t[0])
            )
            out.append(
                Curve(
                    title=f"{self.channels[c]} ({self.model.joints[c]}), held-out {log.name}",
                    unit=self.unit,
                    t=log.t[log.inner],
                    measured=measured[:, c],
                    before=measured[:, c] - residual[:, c],
                    after=measured[:, c] - residual[:, c] + change[:, c],
                    floor=float(self.outcome.floor[c]),
                    spans=spans,
                )
            )
        return out


def _but_held_out(logs: list[JointLog]) -> list[JointLog]:
    return [log for log in logs if log.role != "heldout"]


def _start_mass(logs: list[JointLog]) -> float:
    """Mass of an axis from the log alone, friction and offset fitted beside it [kg]."""
    rows = []
    for log in logs:
        m = log.motion(0)
        rows.append(
            np.column_stack(
                [log.shared(np.stack([m.ddq, m.dq, m.direction, np.ones_like(m.dq)], axis=1)), log.shared(log.measured)]
            )
        )
    table = np.concatenate(rows)
    return float(max(np.linalg.lstsq(table[:, :4], table[:, 4], rcond=None)[0][0], 1e-3))

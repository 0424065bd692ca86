"""The four steps for an axis or an arm."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import GapError
from ..findings import EffectFinding, Gap, Placebo, Rival, VerdictName, Where, told_apart
from ..measurement import SHOWN, Episode, MeasurementSet, require_columns
from ..pictures import Curve
from ..study import Study
from .alternatives import alternatives, best_experiment, experiments, mass_twins
from .arm_model import GRAVITY, ArmModel
from .axis_model import AxisModel
from .block import Block
from .bootstrap import confident, kept_part
from .detect import smallest_found
from .intervals import Intervals, intervals, value_within
from .localise import places
from .log import JointColumns, JointLog, read_logs
from .outcome import Outcome, inadequacy, judge, makes_worse
from .placebo import placebos
from .rigid import RigidModel
from .rivals import parting, rivals
from .robot_files import find_urdf
from .rollout import patched_joints, rollout_gap
from .workflow import Named, explained, name_effects

WRONG_UNIT = 20.0  # numbers this many times too large or too small are in another unit
STRONGEST_GRAVITY = 1e3  # [m/s^2]
LIKE = 0.9  # correlation from which on a speed column is the slope of the position


def columns_of(measured: MeasurementSet) -> JointColumns:
    """Which columns hold position, velocity and load, checked in every episode.

    Raises:
        GapError: one is missing, or its numbers cannot be in the unit the format asks for.
    """
    if measured.system == "axis":
        names = JointColumns(q=("q",), dq=("dq",), load=("force",))
    else:
        first = measured.episodes[0].columns
        n = 0
        while f"q{n + 1}" in first:
            n += 1
        if n == 0:
            require_columns(measured.episodes[0], ["q1"])
        names = JointColumns(
            q=tuple(f"q{i + 1}" for i in range(n)),
            dq=tuple(f"dq{i + 1}" for i in range(n)),
            load=tuple(f"tau{i + 1}" for i in range(n)),
        )
    for episode in measured.episodes:
        require_columns(episode, [*names.q, *names.load])
        step = float(np.median(np.diff(episode.t)))
        if step > 0.5:
            raise GapError(f"{episode.file}: column 't' steps by {step:g}, it must be in seconds (row 3)")
        for name in names.q:
            x = episode.columns[name]
            row = int(np.argmax(np.abs(x)))
            if np.abs(x[row]) > (50.0 if measured.system == "axis" else 40.0):
                unit = "metres" if measured.system == "axis" else "radians"
                raise GapError(f"{episode.file}: column '{name}', row {row + 2} is {x[row]:g}, it must be in {unit}")
            if np.ptp(x) == 0 and len(names.q) == 1:
                raise GapError(
                    f"{episode.file}: column '{name}' never changes (rows 2 to {len(x) + 1}), nothing can be learnt"
                )
        _check_speed(episode, names, "metres" if measured.system == "axis" else "radians")
    return names


def _check_speed(episode: Episode, names: JointColumns, unit: str) -> None:
    """Refuse a speed that is the slope of the position in another unit."""
    for q, dq in zip(names.q, names.dq, strict=True):
        if dq not in episode.columns:
            continue
        slope, speed = np.gradient(episode.columns[q], episode.t), episode.columns[dq]
        if slope.std() == 0 or speed.std() == 0 or np.corrcoef(slope, speed)[0, 1] < LIKE:
            continue
        ratio = float(speed.std() / slope.std())
        if not 1.0 / WRONG_UNIT < ratio < WRONG_UNIT:
            row = int(np.argmax(np.abs(speed)))
            raise GapError(
                f"{episode.file}: column '{dq}', row {row + 2} is {speed[row]:.4g}, the column is {ratio:.3g} times "
                f"the slope of '{q}', it must be in {unit} per second"
            )


def _check_load(measured: MeasurementSet, names: JointColumns, model: RigidModel) -> None:
    """Refuse loads no joint of this robot can have."""
    unit = "N" if measured.system == "axis" else "N m"
    for episode in measured.episodes:
        for name, most in zip(names.load, model.strongest, strict=True):
            x = episode.columns[name]
            row = int(np.argmax(np.abs(x)))
            if abs(x[row]) > WRONG_UNIT * most:
                raise GapError(
                    f"{episode.file}: column '{name}', row {row + 2} is {x[row]:.4g}, it must be in {unit} "
                    f"(this joint is made for {most:.3g})"
                )


def rigid_model(measured: MeasurementSet, joints: int) -> RigidModel:
    """The model the set names.

    Raises:
        GapError: no such robot, or it has fewer joints than the columns.
    """
    if measured.system == "axis":
        return AxisModel(measured.number("mass"))
    robot = measured.settings.get("robot")
    file = measured.folder / "measurement.yaml"
    if not isinstance(robot, str) or not robot:
        raise GapError(f"{file}: `robot` is {robot!r}, an arm needs a URDF file or a name such as ur10 or panda")
    try:
        gravity = measured.settings.get("gravity", GRAVITY)
        if not (
            isinstance(gravity, list | tuple)
            and len(gravity) == 3
            and all(isinstance(g, int | float) and abs(g) < STRONGEST_GRAVITY for g in gravity)
        ):
            raise GapError(f"gravity is {str(gravity)[:SHOWN]}, three numbers [m/s^2] are needed")
        return ArmModel.from_urdf(
            find_urdf(robot, measured.folder), joints, (float(gravity[0]), float(gravity[1]), float(gravity[2]))
        )
    except GapError as error:
        raise GapError(f"{file}: {error}") from None


class JointStudy(Study):
    """An axis or an arm: inverse dynamics residuals, regressors, and short forward rollouts."""

    @cached_property
    def _logs(self) -> tuple[RigidModel, list[JointLog]]:
        columns = columns_of(self.measured)
        model = rigid_model(self.measured, len(columns.q))
        _check_load(self.measured, columns, model)
        logs = read_logs(list(self.measured.episodes), columns, model)
        if isinstance(model, AxisModel) and not model.mass_known:
            fit = [log for log in logs if log.role != "heldout"]
            model = AxisModel(_start_mass(fit))
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
        return [log for log in self._logs[1] if log.role != "heldout"]

    @property
    def heldout(self) -> list[JointLog]:
        """Logs kept for the comparison."""
        return [log for log in self._logs[1] if log.role == "heldout"]

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
        named = confident(name_effects(self.model, self.fitted, self.measured.system), self.fitted)
        if not named.chosen or not makes_worse(named, self.heldout):
            return named, ""
        worse = " and ".join(f"{b.name} on {b.target}" for b in named.blocks)
        return replace(named, blocks=(), chosen=(), theta=np.zeros(0)), worse

    @property
    def named(self) -> Named:
        """The search's result; nothing where the held-out logs are worse with it."""
        return self._searched[0]

    @cached_property
    def outcome(self) -> Outcome:
        """What the search's result amounts to, after a look at what it leaves."""
        return judge(self.named, self.fitted, self.heldout, self.model.joints, self.unit, self._searched[1])

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
            tuple(places(self.measured, self.model.joints, self._logs[1], self.named, self.outcome, self.channels)),
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
        return self.outcome.verdict, tuple(effects), tuple(recalibration), self.outcome.guess

    def _finding(self, k: int, block: Block, theta: np.ndarray, span: slice) -> EffectFinding:
        prismatic = self.model.prismatic[block.channels[0]]
        low, high = self._ends(k, theta, self.intervals.linear[span])
        values = [
            value_within(p, p.unit_for(prismatic), v, a, b)
            for p, v, a, b in zip(block.parameters, theta, low, high, strict=True)
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
            target=block.target,
            parameters=tuple(values),
            experiment=experiment,
            equivalent=(*(" + ".join(a.names) for a in others), *mass_twins(block)),
            size=size,
            smallest=smallest,
            confidence=float(self.kept[k]),
        )

    def rivals(self) -> tuple[Rival, ...]:
        """See `Study.rivals`."""
        if self.outcome.verdict != "effects" or not self.named.chosen:
            return ()
        search, chosen, floor = self.named.search, self.named.chosen, self.named.noise.rms
        out = []
        for other in self._rival_sets:
            blocks = [search.blocks[i] for i in other if not search.blocks[i].recalibration]
            text, apart = parting(search, chosen, other, self._motions, floor)
            name = " + ".join(b.name for b in self.named.blocks)
            names = " + ".join(b.name for b in blocks)
            out.append(Rival(effects=tuple(b.key for b in blocks), experiment=told_apart(text, name, names, apart)))
        return tuple(out)

    @cached_property
    def _rival_sets(self) -> list[tuple[int, ...]]:
        """Other sets of the search's blocks that fit as well."""
        return rivals(self.named.search, self.named.chosen)

    @cached_property
    def _motions(self) -> dict[str, JointLog]:
        """What could be run next."""
        return experiments(self.model, self.fitted[0])

    def _ends(self, k: int, theta: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ends of the intervals of the `k`-th block's numbers, whichever of the sets that fit as well is right."""
        search, index = self.named.search, self.named.chosen[k]
        every = [theta]
        for other in self._rival_sets:
            if index in other:
                at = len(search.columns(other[: other.index(index)]))
                every.append(search.fit(other)[at : at + len(theta)])
        return np.min(every, axis=0) - half, np.max(every, axis=0) + half

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        effects, recalibration = [], []
        at = 0
        for block in self.named.blocks:
            n = len(block.parameters)
            values = {p.name: float(v) for p, v in zip(block.parameters, self.named.theta[at : at + n], strict=True)}
            at += n
            if block.term is not None and not block.recalibration and isinstance(self.model, ArmModel):
                values = self.model.moments(block.term, values)
            elif block.term is None:
                values |= block.shape
            entry = {"name": block.name, "target": block.target, "parameters": {k: float(v) for k, v in values.items()}}
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
            with_it = patched_joints(self.model, tuple(blocks), theta, self.heldout[0].slow)
            pairs = [(rollout_gap(given, log), rollout_gap(with_it, log)) for log in self.heldout[:3]]
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


def gap_of(
    before: list[np.ndarray], after: list[np.ndarray], floor: np.ndarray, channels: tuple[str, ...], unit: str
) -> Gap:
    """The gap over all held-out rows, with an interval of after / before from resampled stretches."""
    b, a = np.concatenate(before), np.concatenate(after)
    rows = np.array_split(np.arange(len(b)), 20)
    sums = np.array([[np.sum(b[r] ** 2), np.sum(a[r] ** 2)] for r in rows])
    rng = np.random.default_rng(0)
    ratios = [
        np.sqrt(s[1] / max(s[0], 1e-30)) for s in (sums[rng.integers(20, size=20)].sum(axis=0) for _ in range(400))
    ]
    low, high = np.quantile(ratios, [0.025, 0.975])
    rb, ra = (np.sqrt(np.mean(x**2, axis=0)) for x in (b, a))
    return Gap(
        unit=unit,
        floor=float(np.sqrt(np.mean(floor**2))),
        before=float(np.sqrt(np.mean(b**2))),
        after=float(np.sqrt(np.mean(a**2))),
        low=float(low),
        high=float(high),
        channels={
            name: {"floor": float(floor[i]), "before": float(rb[i]), "after": float(ra[i])}
            for i, name in enumerate(channels)
        },
    )


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

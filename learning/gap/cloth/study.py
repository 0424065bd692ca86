"""The four steps for cloth."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
from ..errors import GapError
from ..findings import EffectFinding, Gap, Placebo, Rival, Value, VerdictName, Where
from ..measurement import MeasurementSet
from ..pictures import Curve
from ..regions import phase_of, scan
from ..study import Study
from .candidates import Candidate
from .equals import Equals, equals
from .experiment import separating
from .fitting import ClothFitter, ClothModel, predict, scaled
from .noise import coherence, load_misfit, neighbours
from .polish import INSTANTS
from .scene import ClothEpisode, ClothScene, read_scene
from .search import NUMBER, ClothSearch, search
from .simulate import Simulator

REMAINDER = 0.12  # `unknown` above this part of the explainable energy left shared between neighbours
NOTHING = 1e-5  # a recalibrated number this small has run into its bound
STRETCHES = 6  # per recording, resampled for the confidence
TRIED = "the best of the values tried, not fitted with the others, so it has no interval"
ALONE = "it rests on one coordinate of one marker, so nothing is known of how sure it is"
SLOW = 0.8  # [s] for one run
MORE = "record more of the same motions: the effect in which the two differ is near what these can show"
UNITS = {"mass": "kg", "elastic_stiffness": "N/m", "damping_stiffness": "N s/m", "bending_stiffness": "N/m"}


class ClothStudy(Study):
    """Cloth predicted by PyBullet; every comparison is a simulation."""

    def __init__(self, measured: MeasurementSet, alpha: float = 0.05, cache: Path | None = None) -> None:
        super().__init__(measured, alpha)
        self.scene: ClothScene
        self._timed, self._most = False, 3
        self._rejected = ""
        self.scene, self.episodes = read_scene(measured)
        for e, given in zip(self.episodes, measured.episodes, strict=True):
            if not np.ptp(e.markers, axis=0).any():
                raise GapError(f"{given.file}: columns 'm0x' and on never change (rows 2 to {len(e.t) + 1})")
        jobs = int(os.environ.get("CARETREE_JOBS", min(2, os.cpu_count() or 1)))
        self.sim = Simulator(self.scene, cache, jobs)

    @property
    def fitted(self) -> list[ClothEpisode]:
        """Episodes parameters are fitted to; at most three, and two where one run takes long."""
        every = [e for e in self.episodes if e.role != "heldout"]
        if len(every) > 2 and not self._timed:
            self._timed = True
            self.sim.run(every[0])
            self._most = 3 if self.sim.seconds / max(self.sim.runs, 1) < SLOW else 2
        return every[: self._most]

    @property
    def heldout(self) -> list[ClothEpisode]:
        """Episodes kept for the comparison."""
        return [e for e in self.episodes if e.role == "heldout"]

    @cached_property
    def found(self) -> ClothSearch:
        """The search's result; the model as given where the held-out recordings are worse with what it found."""
        import sys

        return self._believed(
            search(self.sim, self.scene, self.fitted, lambda s: print(s, file=sys.stderr, flush=True))
        )

    def _believed(self, found: ClothSearch) -> ClothSearch:
        if not found.chosen:
            return found
        self.sim.ahead([(e, m.acting, m.physics) for e in self.heldout for m in (ClothModel(), found.fit.model)])
        fitter = self._fitter(self.heldout)
        before, after = (_mean2(fitter.residuals(m), self) for m in (ClothModel(), found.fit.model))
        if after <= before:
            return found
        self._rejected = " and ".join(c.name for c in found.chosen)
        return replace(found, chosen=(), fit=found.plain, sure=found.plain, after=found.before, rivals={})

    @property
    def _pairs(self) -> np.ndarray:
        return neighbours(self.scene.vertices[list(self.scene.markers)])

    @cached_property
    def verdict(self) -> VerdictName:
        """One of the four."""
        f = self.found
        if self._rejected:
            return "unknown"
        if f.chosen and (self._load_left > REMAINDER or min(f.fit.model.physics.values(), default=1.0) <= NOTHING):
            return "unknown"  # the markers are followed by what the load, or sense, contradicts
        explained = max(_mean2(f.plain.residuals, self) - _mean2(f.fit.residuals, self), 0.0)
        shared = f.after.shared
        if f.after.p_value < 0.01 and shared > 0.08 * f.after.floor**2 and shared / (shared + explained) > REMAINDER:
            return "unknown"
        if any(not c.recalibration for c in f.chosen):
            return "effects"
        return "recalibration" if f.chosen else "adequate"

    @property
    def _load_left(self) -> float:
        """Part of the load's disagreement that is left, where that is beyond noise; 0 where no load was measured."""
        f, m = self.found, 3 * len(self.scene.markers)
        if load_misfit(f.fit.residuals, [e.load for e in self.fitted], m // 3) >= 0.01:
            return 0.0
        before, after = (sum(float(np.sum(r[:, m:] ** 2)) for r in x.residuals) for x in (f.plain, f.fit))
        return after / max(before, 1e-30)

    def find(self) -> tuple[float, str, tuple[Where, ...]]:
        """See `Study.find`."""
        f = self.found
        p = f.before.p_value
        if self.fitted[0].load is not None:
            off = load_misfit(f.plain.residuals, [e.load for e in self.fitted], len(self.scene.markers))
            p = min(p, off)
        if self.verdict == "adequate":
            p = max(p, self.alpha)
        return p, "what neighbouring markers do not share", tuple(self._places())

    def _places(self) -> list[Where]:
        if self.verdict == "adequate":
            return []
        out = []
        floor = self.found.after.floor
        phases = {e.name: e.phases for e in self.measured.episodes}
        m = len(self.scene.markers)
        named = [c.name for c in self.found.chosen if c.name != "snag"]  # a snag has places of its own
        only = named[0] if len(named) == len(self.found.chosen) == 1 and self.verdict != "unknown" else ""
        for e, r in zip(self.fitted, self.found.plain.residuals, strict=True):
            energy = (r[:, : 3 * m] ** 2).reshape(len(r), m, 3).mean(axis=2)
            worst = int(np.argmax(energy.mean(axis=0)))
            whole = energy.mean(axis=1)
            for a, b in scan(whole, e.t, floor**2, 0.1 * float(e.t[-1])):
                out.append(
                    Where(
                        channel=f"m{worst}",
                        target=f"vertex {self.scene.markers[worst]}",
                        episode=e.name,
                        t0=a,
                        t1=b,
                        state_region=self._state(e, whole),
                        phase=phase_of(phases[e.name], a, b),
                        p_value=self.found.before.p_value,
                        effect=only,
                        size=float(np.sqrt(whole[(e.t >= a) & (e.t <= b)].mean()) / floor),
                    )
                )
        for entry in self.found.fit.model.effects:
            if entry.name == "snag":
                for e in self.episodes:
                    a, b = entry.parameters["t0"], min(entry.parameters["t1"], float(e.t[-1]))
                    out.append(
                        Where(
                            channel=f"m{self._nearest(entry)}",
                            target="region",
                            episode=e.name,
                            t0=a,
                            t1=b,
                            state_region="contact",
                            phase=phase_of(phases[e.name], a, b),
                            effect="snag",
                            p_value=self.found.before.p_value,
                            size=float("nan"),
                        )
                    )
        return out

    def _state(self, e: ClothEpisode, energy: np.ndarray) -> str:
        """Fast or slow cloth, near or away from the body: where the energy is."""
        from ....sim.effects.cloth.adhesion import surface

        speed = np.linalg.norm(np.gradient(e.markers, e.t, axis=0), axis=2).mean(axis=1)
        bins = {"fast motion": speed > np.quantile(speed, 0.75), "slow motion": speed < np.quantile(speed, 0.25)}
        if len(self.scene.capsules):
            near = surface(e.markers.reshape(-1, 3), self.scene.capsules)[0].reshape(len(e.t), -1).min(axis=1) < 0.02
            bins["contact"] = near
        lifts = {k: energy[v].mean() / (energy.mean() + 1e-30) for k, v in bins.items() if 0.03 < v.mean() < 0.8}
        best = max(lifts, key=lambda k: lifts[k], default="everywhere")
        return best if lifts.get(best, 0.0) > 1.5 else "everywhere"

    def _nearest(self, entry: Any) -> int:
        place = np.array([entry.parameters[a] for a in "xyz"])
        return int(np.argmin(np.linalg.norm(self.scene.vertices[list(self.scene.markers)] - place, axis=1)))

    def name(self) -> tuple[VerdictName, tuple[EffectFinding, ...], tuple[EffectFinding, ...], str]:
        """See `Study.name`."""
        f = self.found
        effects, recalibration = [], []
        fitter = self._fitter(self.fitted)
        for c in f.chosen:
            without = fitter.residuals(f.fit.model.without(c.name))
            own = max(_mean2(without, self) - _mean2(f.fit.residuals, self), 0.0)
            size = float(np.sqrt(own) / f.after.floor)
            # the criterion grows with the square of the size, so what would just have paid follows from what was gained
            gained = f.worth * np.log(max(_mean2(without, self), 1e-30) / max(_mean2(f.fit.residuals, self), 1e-30))
            rivals = self._instead(c)
            finding = EffectFinding(
                name=c.name,
                target=c.target,
                parameters=self._values(c),
                equivalent=rivals,
                size=size,
                confidence=self._kept(without, c),
                smallest=float(np.sqrt(NUMBER * len(c.start.free) / max(gained, 1e-9))),
                experiment=separating(self.sim, self.fitted[0], f.fit.model, c.name, rivals[0], f.after.floor)
                if rivals
                else "",
            )
            (recalibration if c.recalibration else effects).append(finding)
        guess = ""
        if self.verdict == "unknown":
            guess = f"{self._rejected} would explain the fitted recordings and make the held-out ones worse"
        if self.verdict == "unknown" and not self._rejected:
            guess = _shape_of(f.fit.residuals, self.fitted, len(self.scene.markers))
        return self.verdict, tuple(effects), tuple(recalibration), guess

    def _values(self, c: Candidate) -> tuple[Value, ...]:
        """The numbers of a candidate with their intervals: those that were fitted, then those that were looked for."""
        f = self.found
        spread = {} if self.equals is None else self.equals.spread
        values = []
        for (name, p), width in zip(f.sure.model.free, f.sure.half, strict=True):
            if name == c.name or (name == "physics" and p == c.name):
                # an instant lies between two steps of the simulation
                half = float(width) + (self.scene.physics.time_step if (name, p) in INSTANTS else 0.0)
                x = f.fit.model.value((name, p))
                unit = UNITS.get(p, "") if name == "physics" else _unit(name, p)
                ends = (x - half, x + half, *spread.get((name, p), ()))
                doubt = "" if np.isfinite(half) else ALONE
                values.append(Value(name=p, unit=unit, value=x, low=min(ends), high=max(ends), doubt=doubt))
        entry = next((e for e in f.fit.model.effects if e.name == c.name), None)
        fixed = {v.name for v in values}
        for p, x in (entry.parameters if entry else {}).items():
            if p not in fixed:
                values.append(Value(name=p, unit=_unit(c.name, p), value=x, low=x, high=x, doubt=TRIED))
        return tuple(values)

    def _instead(self, c: Candidate) -> tuple[str, ...]:
        """What could stand in for a candidate; where nothing is named for sure, what fitted alike in its round."""
        alike = self.found.rivals if self.equals is None else self.equals.instead
        return alike.get(c.name, ())

    @cached_property
    def equals(self) -> Equals | None:
        """What cannot be told from the named effects; None where none are named for sure."""
        if self.verdict != "effects":
            return None
        return equals(self.sim, self.scene, self.fitted, self.heldout, self.found)

    def rivals(self) -> tuple[Rival, ...]:
        """See `Study.rivals`."""
        if self.equals is None:
            return ()
        return tuple(Rival(effects=names, experiment=MORE) for names in self.equals.sets)

    def _kept(self, without: list[np.ndarray], c: Candidate) -> float:
        """Part of resampled stretches in which a candidate keeps paying its price."""
        width = 3 * len(self.scene.markers)
        table = np.array(
            [
                (np.sum(a[rows, :width] ** 2), np.sum(b[rows, :width] ** 2))
                for a, b in zip(without, self.found.fit.residuals, strict=True)
                for rows in np.array_split(np.arange(len(a)), STRETCHES)
            ]
        )
        rng = np.random.default_rng(0)
        draws = table[rng.integers(len(table), size=(200, len(table)))].sum(axis=1)
        gained = self.found.worth * np.log(np.maximum(draws[:, 0], 1e-30) / np.maximum(draws[:, 1], 1e-30))
        return float(np.mean(gained > NUMBER * len(c.start.free)))

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        model = self.found.fit.model
        return {
            "system": "cloth",
            "mesh": self.measured.settings.get("mesh"),
            "recalibration": [
                {"name": k, "target": "cloth", "parameters": {k: float(v)}} for k, v in model.physics.items()
            ],
            "effects": [{"name": e.name, "target": e.target, "parameters": dict(e.parameters)} for e in model.effects],
        }

    def _fitter(self, episodes: list[ClothEpisode]) -> ClothFitter:
        width = 3 * len(self.scene.markers) + (3 if episodes[0].load is not None else 0)
        return ClothFitter(self.sim, episodes, np.ones(width))

    def show(self) -> tuple[Gap, Gap | None, tuple[Placebo, ...], dict[str, str]]:
        """See `Study.show`."""
        model = self.found.fit.model
        self.sim.ahead([(e, m.acting, m.physics) for e in self.heldout for m in (ClothModel(), model)])
        fitter = self._fitter(self.heldout)
        before, after = fitter.residuals(ClothModel()), fitter.residuals(model)
        m = len(self.scene.markers)
        floor = min(coherence(after, self._pairs, m).floor, self.found.after.floor)
        groups = {f"m{k}": slice(3 * k, 3 * k + 3) for k in range(m)}
        channels = {n: {"floor": floor, "before": _rms(before, s), "after": _rms(after, s)} for n, s in groups.items()}
        every = slice(0, 3 * m)
        sums = np.array(
            [
                [np.sum(b[k, every] ** 2), np.sum(a[k, every] ** 2)]
                for b, a in zip(before, after, strict=True)
                for k in np.array_split(np.arange(len(b)), 10)
            ]
        )
        rng = np.random.default_rng(0)
        ratio = [
            np.sqrt(s[1] / max(s[0], 1e-30))
            for s in (sums[rng.integers(len(sums), size=len(sums))].sum(axis=0) for _ in range(300))
        ]
        low, high = np.quantile(ratio, [0.025, 0.975])
        gap = Gap(
            unit="m",
            floor=floor,
            before=_rms(before, every),
            after=_rms(after, every),
            low=float(low),
            high=float(high),
            channels=channels,
        )
        return gap, None, self._placebos(before, model, fitter), {}

    def _placebos(self, before: list[np.ndarray], model: ClothModel, fitter: ClothFitter) -> tuple[Placebo, ...]:
        if not model.effects:
            return ()
        zero = ClothModel(effects=(), physics={}, free=())
        first = self.found.chosen[0]
        if first.recalibration:
            return ()
        turned = scaled(
            ClothModel(effects=tuple(e for e in model.effects if e.name == first.name), free=first.start.free),
            -0.5,
            first.start,
        )
        x = _mean2(fitter.residuals(turned), self)
        return (
            Placebo(
                what=f"{first.name} with half its size and, where it can have one, the other sign",
                ratio=float(np.sqrt(x / max(_mean2(fitter.residuals(zero), self), 1e-30))),
            ),
        )

    def curves(self) -> list[Curve]:
        """The markers that move most against the model, on the first held-out episode."""
        e = self.heldout[0]
        before = predict(self.sim, ClothModel(), [e])[0]
        after = predict(self.sim, self.found.fit.model, [e])[0]
        flat = e.markers.reshape(len(e.t), -1)
        m = 3 * len(self.scene.markers)
        order = np.argsort(-np.mean((flat - before[:, :m]) ** 2, axis=0))
        picked = sorted(
            {int(i) for i in order[:1]}
            | {int(i) for i in order if i // 3 != order[0] // 3 and i != order[0] and list(order).index(i) < 8}
            | set()
        )[:3]
        return [
            Curve(
                title=f"marker {i // 3} {'xyz'[i % 3]}, held-out {e.name}",
                unit="m",
                t=e.t,
                measured=flat[:, i],
                before=before[:, i],
                after=after[:, i],
                floor=self.found.after.floor,
            )
            for i in picked
        ]


def _rms(residuals: list[np.ndarray], columns: slice) -> float:
    return float(np.sqrt(np.mean(np.concatenate([r[:, columns] for r in residuals]) ** 2)))


def _mean2(residuals: list[np.ndarray], study: ClothStudy) -> float:
    m = 3 * len(study.scene.markers)
    return float(np.mean(np.concatenate([r[:, :m] for r in residuals]) ** 2))


def _unit(effect: str, parameter: str) -> str:
    return next((p.unit for p in CLOTH_EFFECTS[effect].parameters if p.name == parameter), "")


def _shape_of(residuals: list[np.ndarray], episodes: list[ClothEpisode], markers: int) -> str:
    """Shape of the leftover in words: along which axis, common to all markers or stretching them, and its rhythm."""
    x = np.concatenate([r[:, : 3 * markers].reshape(len(r), markers, 3) for r in residuals])
    axis = int(np.argmax(np.mean(x**2, axis=(0, 1))))
    together = x.mean(axis=1)
    common = float(np.mean(together**2) / (np.mean(x**2) + 1e-30))
    series, t = residuals[0][:, : 3 * markers], episodes[0].t
    u, s, _ = np.linalg.svd(series - series.mean(axis=0), full_matrices=False)
    power = np.abs(np.fft.rfft(u[:, 0] * s[0])) ** 2
    k = int(np.argmax(power[1:])) + 1
    period = float(t[-1] - t[0]) / k
    rhythm = f", period about {period:.2f} s" if power[k] > 0.4 * power[1:].sum() and k > 1 else ""
    kind = "all markers move together" if common > 0.5 else "markers move against each other"
    return f"mostly along {'xyz'[axis]}, {kind}{rhythm}"

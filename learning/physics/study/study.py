"""Every method on every test: predictions first, kept so that an interrupted study goes on, then the table."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ..clips.gown_cuts import same_cut
from ..clips.parameters import SHOWN, values_to_unit
from ..methods.examples import Loaded
from ..methods.gp_inversion import SORTS, GPInversion, fit_gp_inversion
from ..methods.inversion import SCORES
from ..methods.method import Examples
from ..methods.pca import fit_compression
from ..methods.simulator import Simulator
from ..methods.weights import load_weights, save_weights
from ..networks.training import machine
from ..networks.trivial_baselines import ManualTuning, RandomParameters, class_centres, settings
from .registry import NETWORKS, Plan, fit_network

PIECE = 10  # clips simulated between two savings


@dataclass(frozen=True, kw_only=True)
class Study:
    """What is compared.

    Attributes:
        data: what the methods are trained on; its part `test` is the first test.
        tests: more tests, the part `test` of each, by name.
        plan: how the networks are trained.
        seeds: of the trainings.
        simulate: clips of each test that are corrected by simulation, which takes more than half a second each.
        calibrate: validation clips of each sort that set the intervals' widths for these.
        cuts: clips of many other cuts; all methods learn from their part `train` too, and the others are used likewise.
    """

    data: Loaded
    tests: dict[str, Loaded]
    plan: Plan
    seeds: tuple[int, ...]
    simulate: int = 100
    calibrate: int = 100
    cuts: Loaded | None = None

    @property
    def folder(self) -> Path:
        """Of weights and predictions."""
        return self.plan.folder

    def view(self) -> Callable[[Examples], Examples]:
        """What the networks are given of clips: tensors of frames, or of scores where that is the backbone."""
        if self.plan.backbone != "scores":
            return lambda clips: replace(clips, frames=torch.from_numpy(clips.frames))
        compression = fit_compression(self.train().frames, SCORES)
        return lambda clips: replace(clips, frames=torch.from_numpy(compression(clips.frames)).float())

    def train(self) -> Examples:
        """What the networks learn from."""
        own = self.data.part("train")
        return own.joined(self.cuts.part("train")) if self.cuts else own

    @property
    def hash(self) -> str:
        """Of all data that is learned from."""
        return self.data.examples.hash + (f"+{self.cuts.examples.hash}" if self.cuts else "")

    def gp_inversion(self, say: Callable[[str], None]) -> GPInversion:
        """GP inversion, fitted and calibrated, or as it was left in the folder."""
        path = self.folder / "gp_inversion.safetensors"
        method, calibrated_on, before = None, 0, -time.process_time()
        if path.exists():
            kept, record = load_weights(path)
            if record["data"] == self.hash:
                method, calibrated_on = kept, record["calibrated_on"]
                before += record.get("processor_seconds", 0.0)
        if method is None:
            others = (self.cuts.part("train"), self.cuts.part("val")) if self.cuts else None
            method = fit_gp_inversion(
                self.data.part("train"), self.data.part("val"), others, seed=self.seeds[0], shown=SHOWN
            )
            self._save(method, path, 0, before)  # what follows takes much longer than the fit, and may be interrupted
        if self.calibrate and calibrated_on != self.calibrate:
            self._calibrate(method, say)
            self._save(method, path, self.calibrate, before)
        return method

    def _save(self, method: GPInversion, path: Path, calibrated_on: int, before: float) -> None:
        clips = sum(int((one.split == "train").sum()) for one in (self.data, self.cuts) if one)
        save_weights(method, path, {
            "method": "gp_inversion", "data": self.hash, "kind": self.data.kind, "seed": self.seeds[0],
            "clips": clips, "calibrated_on": calibrated_on, "machine": machine(),
            "processor_seconds": round(before + time.process_time(), 3),
        })  # fmt: skip

    def _calibrate(self, method: GPInversion, say: Callable[[str], None]) -> None:
        for (rough, other), name in SORTS.items():
            loaded = self.cuts if other else self.data
            if name not in method.inversions or loaded is None:
                continue
            index = loaded.where("val")
            sort = index[loaded.examples.gaps[index] == rough]
            some = np.random.default_rng(0).permutation(sort)[: self.calibrate]  # more later keep these
            found = self._simulated(f"widths_{name}", loaded, some, method, say)
            method.inversions[name].set_widths("simulated", loaded.examples.unit[some], *found)

    def test_sets(self) -> Iterator[tuple[str, Loaded, np.ndarray]]:
        """Name, origin and indices of the clips of each test."""
        index = self.data.where("test")
        if self.data.kind == "mixed":  # the first view of each fall, which is that of `uniform`
            index = index[~self.data.examples.gaps[index]]
        yield "uniform" if self.data.kind == "mixed" else self.data.kind, self.data, index
        for name, loaded in self.tests.items():
            yield name, loaded, loaded.where("test")
        if self.cuts:
            index = self.cuts.where("test")
            for name, rough in (("cuts", False), ("cuts_rough", True)):
                if (self.cuts.examples.gaps[index] == rough).any():
                    yield name, self.cuts, index[self.cuts.examples.gaps[index] == rough]

    def run(self, say: Callable[[str], None], only: tuple[str, ...] = ()) -> None:
        """Make all predictions that are missing, of all methods or of the named ones."""
        self._forget_other_data()
        sets = list(self.test_sets())

        def wanted(name: str) -> bool:
            return not only or name in only

        todo = [
            (seed, name)
            for seed in self.seeds
            for name in NETWORKS
            if wanted(name) and any(not self._file(t, name, seed).exists() for t, _, _ in sets)
        ]
        if todo:
            view = self.view()
            train = view(self.train())
            seen = [(test, view(loaded.examples.part(index))) for test, loaded, index in sets]
            for seed, name in todo:
                method = fit_network(name, train, self.plan, seed)
                for test, clips in seen:
                    self._keep(test, name, seed, clips.unit, unit=method.estimate(clips.frames))
        first = self.seeds[0]
        if wanted("random"):
            for seed in self.seeds:
                for test, loaded, index in sets:
                    clips = loaded.examples.part(index)
                    self._keep(test, "random", seed, clips.unit, unit=RandomParameters(seed).estimate(clips.frames))
        if wanted("manual"):
            tried = values_to_unit(settings())
            by_hand = ManualTuning(tried, Simulator(self.data.gowns[0])(tried))
            for test, loaded, index in sets:
                clips = loaded.examples.part(index)
                self._keep(test, "manual", first, clips.unit, unit=by_hand.estimate(clips.frames))
        if wanted("class_centre") and (self.data.examples.class_id >= 0).all():
            test, loaded, index = sets[0]  # its classes are those of the part `train`
            clips = loaded.examples.part(index)
            self._keep(
                test, "class_centre", first, clips.unit, unit=class_centres(self.data.part("train"), clips.class_id)
            )
        if wanted("gp_inversion"):
            self._predict_gp_inversion(sets, say)

    def _predict_gp_inversion(self, sets: list[tuple[str, Loaded, np.ndarray]], say: Callable[[str], None]) -> None:
        method, seed = self.gp_inversion(say), self.seeds[0]
        for test, loaded, index in sets:
            clips, other = loaded.examples.part(index), not same_cut(loaded.gowns[index[0]], self.data.gowns[0])
            found = method.infer(clips, other=other)
            self._keep(test, "gp_inversion", seed, clips.unit, unit=found.unit, lower=found.lower, upper=found.upper)
            sorts = [method.sort(rough, other) for rough in np.unique(clips.gaps)]
            if not self.simulate or not all("simulated" in sort.widths for sort in sorts):
                continue
            some = index[: self.simulate]
            gaps = loaded.examples.gaps[some]
            found = method.judged("simulated", gaps, *self._simulated(test, loaded, some, method, say), other=other)
            self._keep(
                test,
                "gp_inversion_simulated",
                seed,
                loaded.examples.unit[some],
                unit=found.unit,
                lower=found.lower,
                upper=found.upper,
            )

    def _simulated(
        self, name: str, loaded: Loaded, index: np.ndarray, method: GPInversion, say: Callable[[str], None]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Parameters and misfits after correction by simulation, kept piece by piece."""
        pieces = []
        for start in range(0, len(index), PIECE):
            path = self._file(name, f"piece-{start}", self.seeds[0])
            if not path.exists():
                part = index[start : start + PIECE]
                clips = loaded.examples.part(part)
                unit, misfit = method.raw(
                    clips,
                    lambda k, part=part: Simulator([loaded.gowns[i] for i in part[k]]),
                    other=not same_cut(loaded.gowns[part[0]], self.data.gowns[0]),
                )
                self._keep(name, f"piece-{start}", self.seeds[0], clips.unit, unit=unit, misfit=misfit)
                say(f"{name}: {start + len(part)} of {len(index)} clips corrected by simulation")
            with np.load(path) as file:
                pieces.append((file["unit"], file["misfit"]))
        return np.concatenate([unit for unit, _ in pieces]), np.concatenate([misfit for _, misfit in pieces])

    def _forget_other_data(self) -> None:
        """Remove predictions of methods that learned from other data, and those of other clips than now."""
        now = {"": self.hash, **{name: one.examples.hash for name, one in self.tests.items()}}
        folder = self.folder / "predictions"
        folder.mkdir(parents=True, exist_ok=True)
        known = folder / "data.json"
        before = json.loads(known.read_text()) if known.exists() else {}
        for name in now:
            if before.get(name, now[name]) != now[name]:
                for path in folder.glob(f"{name}*.npz"):
                    path.unlink()
        known.write_text(json.dumps({**before, **now}))

    def _file(self, test: str, method: str, seed: int) -> Path:
        return self.folder / "predictions" / f"{test}-{method}-{seed}.npz"

    def _keep(self, test: str, method: str, seed: int, true: np.ndarray, **arrays: np.ndarray) -> None:
        path = self._file(test, method, seed)
        part = path.with_suffix(".part.npz")
        np.savez(part, allow_pickle=False, **{"true": true, **arrays})
        os.replace(part, path)


def predictions(folder: Path) -> Iterator[tuple[str, str, int, dict[str, np.ndarray]]]:
    """Test, method, seed and arrays that a folder keeps: `true`, `unit`, and of GP inversion `lower` and `upper`."""
    for path in sorted((folder / "predictions").glob("*.npz")):
        test, method, *_, seed = path.stem.split("-")
        if method != "piece" and len(path.suffixes) == 1:  # no part of a file, and no file cut short
            with np.load(path) as file:
                yield test, method, int(seed), dict(file)

"""Every method on every test: predictions first, kept so that an interrupted study goes on, then the table."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .compression import fit_compression
from .examples import Loaded
from .method import Examples
from .methods import NETWORKS, Plan, fit_network
from .ours import SCORES, Inversion, fit_ours
from .parameters import SHOWN, values_to_unit
from .simulator import Simulator
from .training import machine
from .untrained import ManualTuning, RandomParameters, settings
from .weights import load_weights, save_weights

PIECE = 10  # clips simulated between two savings


@dataclass(frozen=True, kw_only=True)
class Study:
    """What is compared.

    Attributes:
        data: what the methods are trained on; its part `test` is the first test.
        tests: more tests, all their clips, by name.
        plan: how the networks are trained.
        seeds: of the trainings.
        simulate: clips of each test that are corrected by simulation, which takes about a second each.
        calibrate: validation clips that set the intervals' widths for these.
    """

    data: Loaded
    tests: dict[str, Loaded]
    plan: Plan
    seeds: tuple[int, ...]
    simulate: int = 100
    calibrate: int = 100

    @property
    def folder(self) -> Path:
        """Of weights and predictions."""
        return self.plan.folder

    def view(self) -> Callable[[Examples], Examples]:
        """What the networks are given of clips: frames, or scores where that is the backbone."""
        if self.plan.backbone != "scores":
            return lambda clips: clips
        compression = fit_compression(self.data.part("train").frames, SCORES)
        return lambda clips: replace(clips, frames=compression(clips.frames))

    def ours(self, say: Callable[[str], None]) -> Inversion:
        """Our method, fitted and calibrated, or as it was left in the folder."""
        path = self.folder / "ours.safetensors"
        valid, method, calibrated_on = self.data.part("val"), None, 0
        if path.exists():
            kept, record = load_weights(path)
            if record["data"] == self.data.examples.hash:
                method, calibrated_on = kept, record["calibrated_on"]
        if method is None:
            method = fit_ours(self.data.part("train"), valid, seed=self.seeds[0], shown=SHOWN)
        elif calibrated_on == self.calibrate:
            return method
        if self.calibrate:
            some = valid.part(np.arange(min(self.calibrate, len(valid))))
            method.set_widths("simulated", some.unit, *self._simulated("val", some, self.data, method, say))
        save_weights(method, path, {
            "method": "ours", "data": self.data.examples.hash, "kind": self.data.kind, "seed": self.seeds[0],
            "clips": int((self.data.split == "train").sum()), "calibrated_on": self.calibrate, "machine": machine(),
        })  # fmt: skip
        return method

    def test_sets(self) -> Iterator[tuple[str, Examples, Loaded]]:
        """Name, clips and origin of each test."""
        yield self.data.kind, self.data.part("test"), self.data
        for name, loaded in self.tests.items():
            yield name, loaded.examples, loaded

    def run(self, say: Callable[[str], None], only: tuple[str, ...] = ()) -> None:
        """Make all predictions that are missing, of all methods or of the named ones."""
        sets = list(self.test_sets())
        wanted = lambda name: not only or name in only  # noqa: E731
        todo = [(seed, name) for seed in self.seeds for name in NETWORKS if wanted(name)
                and any(not self._file(t, name, seed).exists() for t, _, _ in sets)]
        if todo:
            view = self.view()
            train, seen = view(self.data.part("train")), [(test, view(clips)) for test, clips, _ in sets]
            for seed, name in todo:
                method = fit_network(name, train, self.plan, seed)
                for test, clips in seen:
                    self._keep(test, name, seed, clips, unit=method.estimate(clips.frames))
        first = self.seeds[0]
        if wanted("random"):
            for seed in self.seeds:
                for test, clips, _ in sets:
                    self._keep(test, "random", seed, clips, unit=RandomParameters(seed).estimate(clips.frames))
        if wanted("manual"):
            tried = values_to_unit(settings())
            by_hand = ManualTuning(tried, Simulator(self.data.gown)(tried))
            for test, clips, _ in sets:
                self._keep(test, "manual", first, clips, unit=by_hand.estimate(clips.frames))
        if wanted("ours"):
            self._ours(sets, say)

    def _ours(self, sets: list[tuple[str, Examples, Loaded]], say: Callable[[str], None]) -> None:
        method, seed = self.ours(say), self.seeds[0]
        for test, clips, origin in sets:
            found = method.infer(clips.frames)
            self._keep(test, "ours", seed, clips, unit=found.unit, lower=found.lower, upper=found.upper)
            if "simulated" not in method.widths or not self.simulate:
                continue
            some = clips.part(np.arange(min(self.simulate, len(clips))))
            found = method.judged("simulated", *self._simulated(test, some, origin, method, say))
            self._keep(test, "ours_simulated", seed, some, unit=found.unit, lower=found.lower, upper=found.upper)

    def _simulated(
        self, test: str, clips: Examples, origin: Loaded, method: Inversion, say: Callable[[str], None]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Parameters and misfits after correction by simulation, kept piece by piece."""
        pieces = []
        for start in range(0, len(clips), PIECE):
            path = self._file(test, f"piece-{start}", self.seeds[0])
            if not path.exists():
                piece = clips.part(np.arange(start, min(start + PIECE, len(clips))))
                unit, misfit = method.simulated(piece.frames, Simulator(origin.gown))
                self._keep(test, f"piece-{start}", self.seeds[0], piece, unit=unit, misfit=misfit)
                say(f"{test}: {start + len(piece)} of {len(clips)} clips corrected by simulation")
            with np.load(path) as file:
                pieces.append((file["unit"], file["misfit"]))
        return np.concatenate([unit for unit, _ in pieces]), np.concatenate([misfit for _, misfit in pieces])

    def _file(self, test: str, method: str, seed: int) -> Path:
        return self.folder / "predictions" / f"{test}-{method}-{seed}.npz"

    def _keep(self, test: str, method: str, seed: int, clips: Examples, **arrays: np.ndarray) -> None:
        path = self._file(test, method, seed)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        np.savez(part, allow_pickle=False, **{"true": clips.unit, **arrays})
        os.replace(part, path)

    def predictions(self) -> Iterator[tuple[str, str, int, dict[str, np.ndarray]]]:
        """Test, method, seed and arrays (`true`, `unit`, and of ours `lower`, `upper`) of all that is kept."""
        for path in sorted((self.folder / "predictions").glob("*.npz")):
            test, method, *_, seed = path.stem.split("-")
            if method != "piece" and len(path.suffixes) == 1:  # no part of a file, and no file cut short
                with np.load(path) as file:
                    yield test, method, int(seed), dict(file)

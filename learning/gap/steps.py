"""The four steps on disk: each writes one file and reads the one before it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...sim.effects.model_file import load_model, save_model
from .errors import GapError
from .findings import Verdict, plain
from .measurement import load_set
from .open_study import open_study
from .own.find_system import absolute, find_system, installed
from .report import write_report
from .study import Study

Say = Callable[[str], None]


def find(folder: Path, out: Path, alpha: float, say: Say, system: str = "") -> Study:
    """Write find.json: whether the model is adequate, the floor, and where not.

    Args:
        folder: the measurement set.
        out: folder for the results.
        alpha: level of the tests.
        say: told what is being done.
        system: `path.py:Class` or the name of an entry point, for a simulator of one's own.
    """
    study = _opened(Path(folder), alpha, out, system)
    say("find: noise floor and places")
    p_value, source, where = study.find()
    _write(
        out / "find.json",
        {
            "set": str(Path(folder).resolve()),
            "alpha": alpha,
            "simulator": study.source,
            "p_value": p_value,
            "floor_source": source,
            "adequate": bool(p_value >= alpha),
            "where": [w.__dict__ for w in where],
        },
    )
    return study


def name(out: Path, say: Say, study: Study | None = None) -> Study:
    """Write name.json: what is missing."""
    study = study or _again(out, "find.json")
    say("name: search of the registry")
    verdict, effects, recalibration, guess = study.name()
    _write(
        out / "name.json",
        {
            "set": str(study.measured.folder.resolve()),
            "alpha": study.alpha,
            "simulator": study.source,
            "verdict": verdict,
            "effects": [_finding(f) for f in effects],
            "recalibration": [_finding(f) for f in recalibration],
            "guess": guess,
        },
    )
    return study


def add(out: Path, say: Say, study: Study | None = None) -> Study:
    """Write model.yaml and read it back, so that a file no world can load is never left behind."""
    study = study or _again(out, "name.json")
    say("add: model.yaml")
    save_model(out / "model.yaml", plain(study.patch()))
    load_model(out / "model.yaml")
    return study


def show(out: Path, say: Say, study: Study | None = None, started: float | None = None) -> Verdict:
    """Write verdict.json and report.html: the held-out gap before and after."""
    study = study or _again(out, "name.json")
    if not (out / "model.yaml").is_file():
        raise GapError(f"{out / 'model.yaml'}: no such file, run `caretree gap add {out}` first")
    say("show: held-out episodes, controls, report")
    started = time.monotonic() if started is None else started
    verdict = study.conclude(time.monotonic() - started)
    _write(out / "verdict.json", verdict.as_dict())
    (out / "report.html").write_text(write_report(verdict, study.curves()), encoding="utf-8")
    return verdict


def _finding(f: Any) -> dict[str, Any]:
    return {**f.__dict__, "parameters": [x.__dict__ for x in f.parameters]}


def _again(out: Path, needed: str) -> Study:
    file = out / needed
    if not file.is_file():
        step = "find SET --out" if needed == "find.json" else "name"
        raise GapError(f"{file}: no such file, run `caretree gap {step} {out}` first")
    try:
        content = json.loads(file.read_text())
        folder, alpha, system = content["set"], float(content["alpha"]), str(content.get("simulator", ""))
    except (ValueError, KeyError, TypeError):
        raise GapError(f"{file}: not written by `caretree gap`, run the step before it again") from None
    return _opened(Path(folder), alpha, out, system)


def _opened(folder: Path, alpha: float, out: Path, system: str) -> Study:
    if not system:
        return open_study(load_set(folder, tuple(installed())), alpha, cache=out / "cache")
    own = find_system(system)
    return open_study(load_set(folder, (own.name,)), alpha, own=own, source=absolute(system))


def _write(file: Path, content: dict[str, Any]) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_suffix(".part")  # an interrupt must not leave half a file behind
    part.write_text(json.dumps(plain(content), indent=1), encoding="utf-8")
    part.replace(file)

"""The workflow on arrays and frames, without files: `from caretree.gap import run`."""

from __future__ import annotations

import inspect
import json
import time
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from ...sim.effects.model_file import load_model, save_model
from .errors import GapError
from .findings import Verdict, plain
from .measurement import SYSTEMS, set_of
from .open_study import open_study
from .own.find_system import absolute, find_system, made
from .own.system import System, check_system
from .report import write_report
from .study import Study


@dataclass(frozen=True)
class Result:
    """What the workflow says, shown as the report where a notebook shows it.

    Attributes:
        verdict: as verdict.json holds it.
        study: for questions about it.
    """

    verdict: Verdict
    study: Study

    @property
    def model(self) -> dict[str, Any]:
        """Content of model.yaml, plain values."""
        return plain(self.study.patch())

    @cached_property
    def html(self) -> str:
        """The report as a page of its own."""
        return write_report(self.verdict, self.study.curves())

    def _repr_html_(self) -> str:
        return self.html

    def __repr__(self) -> str:
        v = self.verdict
        named = ", ".join(f"{f.name} on {f.target}" for f in (*v.effects, *v.recalibration)) or "nothing"
        return f"{v.verdict}: {named}; held-out gap {v.gap.before:.4g} -> {v.gap.after:.4g} {v.gap.unit}"

    def save(self, folder: Path | str) -> Path:
        """Write report.html, verdict.json and model.yaml into a folder, and say where."""
        out = Path(folder)
        out.mkdir(parents=True, exist_ok=True)
        save_model(out / "model.yaml", self.model)
        load_model(out / "model.yaml")
        (out / "verdict.json").write_text(json.dumps(plain(self.verdict.as_dict()), indent=1), encoding="utf-8")
        (out / "report.html").write_text(self.html, encoding="utf-8")
        return out


def run(
    system: str | System | type[System],
    fit: Iterable[Any],
    heldout: Iterable[Any],
    repeats: Iterable[Any] = (),
    alpha: float = 0.05,
    **settings: Any,
) -> Result:
    """Find where model and measurement disagree, name what is missing, and show on held-out tables that it shrinks.

    Args:
        system: `arm`, `axis`, `fall`, `cloth`, `path.py:Class`, an installed one's name, or a System or its class.
        fit: tables parameters are fitted to; a table is a mapping of names to arrays or a frame, with `t` [s].
        heldout: tables kept for the comparison.
        repeats: tables of one motion made again.
        alpha: level of the tests.
        **settings: what measurement.yaml says beside, such as `mass` or `robot`.

    Raises:
        GapError: something in it cannot be used; one sentence.
    """
    started = time.monotonic()
    own, source = None, ""
    if isinstance(system, type):
        system = made(system, system.__name__)
    if not 0.0 < _number(alpha) < 1.0:
        raise GapError(f"alpha is {alpha!r}, a level between 0 and 1 is needed")
    if isinstance(system, System):
        own, source = check_system(system), _source(type(system))
    elif not isinstance(system, str):
        raise GapError(f"system is {system!r:.60}, it must be a System, its class, or one of {', '.join(SYSTEMS)}")
    elif system not in SYSTEMS:
        own, source = find_system(system), absolute(system)
    measured = set_of(own.name if own else str(system), fit, heldout, repeats, **settings)
    study = open_study(measured, alpha, own=own, source=source)
    verdict = study.conclude()
    return Result(verdict=replace(verdict, seconds=time.monotonic() - started), study=study)


def _number(given: Any) -> float:
    """What is given, or no number at all."""
    return float(given) if isinstance(given, int | float) else float("nan")


def _source(kind: type) -> str:
    """Where a class was written, or its name alone where that is no file, as in a notebook."""
    try:
        return f"{Path(inspect.getfile(kind)).resolve()}:{kind.__name__}"
    except (TypeError, OSError):
        return kind.__name__

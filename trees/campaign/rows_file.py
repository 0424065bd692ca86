"""The trials of a campaign as a table for other programs: one row a trial, CSV, and Parquet where pyarrow is there."""

from __future__ import annotations

import csv
import importlib
import os
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.record.spool import disk_error
from .trial import Trial

CSV, PARQUET = "trials.csv", "trials.parquet"


def rows_of(trials: dict[str, list[Trial]]) -> list[dict[str, Any]]:
    """One flat row a trial; all rows have the same columns, in the same order."""
    rows = []
    for kind, many in trials.items():
        for trial in many:
            row: dict[str, Any] = {"kind": kind, **{name: getattr(trial, name) for name in _plain()}}
            row |= {"succeeded": trial.succeeded, "problems": "; ".join(trial.problems)}
            row |= {f"stage {name}": status for name, status in trial.stages.items()}
            row |= {str(name): value for name, value in trial.numbers.items()}
            rows.append(row)
    columns = list(dict.fromkeys(name for row in rows for name in row))
    return [{name: row.get(name) for name in columns} for row in rows]


def _plain() -> list[str]:
    mapped = ("problems", "numbers", "stages")
    return [name for name in Trial.__dataclass_fields__ if name not in mapped]


def write_csv(directory: Path, trials: dict[str, list[Trial]]) -> None:
    """Write trials.csv whole.

    Raises:
        CaretreeError: it cannot be written.
    """
    rows, path = rows_of(trials), directory / CSV
    part = path.with_name(f"{CSV}.{os.getpid()}.part")
    try:
        with part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]) if rows else ["kind", "seed", "outcome"])
            writer.writeheader()
            writer.writerows(rows)
        part.replace(path)
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def write_parquet(directory: Path, trials: dict[str, list[Trial]]) -> Path:
    """Write trials.parquet.

    Raises:
        CaretreeError: pyarrow is not installed, or the file cannot be written.
    """
    try:
        arrow, parquet = importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise CaretreeError("--parquet needs pyarrow: pip install 'caretree[parquet]'") from error
    path = directory / PARQUET
    try:
        parquet.write_table(arrow.Table.from_pylist(rows_of(trials)), path)
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error
    return path

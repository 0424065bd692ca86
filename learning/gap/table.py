"""One CSV of a measurement set, read strictly: every complaint names file, column and row."""

from __future__ import annotations

import csv
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .errors import GapError

FEWEST = 12  # rows that can say anything


def read_table(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV with a header line, first column `t` [s], every cell a finite number.

    Returns:
        name -> (T,) float array, in file order.

    Raises:
        GapError: the file is missing, empty, ragged or not numeric, or time does not increase.
    """
    if not path.is_file():
        raise GapError(f"{path}: no such file")
    quick = _quick(path)
    if quick is not None:
        return quick
    header, rows = _lines(path)
    try:
        data = np.array(rows, dtype=float)
    except ValueError:
        data = np.array(
            [[_number(path, header[j], i, cell) for j, cell in enumerate(row)] for i, row in enumerate(rows, start=2)]
        )
    bad = np.argwhere(~np.isfinite(data))
    if len(bad):
        i, j = bad[0]
        cell = rows[i][j].strip()[:40] or "blank"
        raise GapError(f"{path}: column '{header[j]}', row {i + 2} is {cell}, a finite number is needed")
    back = np.flatnonzero(np.diff(data[:, 0]) <= 0)
    if len(back):
        raise GapError(
            f"{path}: column 't', row {back[0] + 3}: time does not increase "
            f"({data[back[0], 0]:g} then {data[back[0] + 1, 0]:g})"
        )
    return {name: data[:, j] for j, name in enumerate(header)}


def is_table(given: Any) -> bool:
    """Whether it has columns by name, as a mapping or a frame has."""
    return isinstance(given, Mapping) or _names(given) is not None


def _names(given: Any) -> Any:
    """Of the columns of a frame; None for anything else."""
    return getattr(given, "columns", getattr(getattr(given, "dtype", None), "names", None))


def table_of(table: Any, name: str) -> dict[str, np.ndarray]:
    """Columns of a table in memory, under the rules of `read_table`.

    Args:
        table: a mapping of names to arrays, or a frame (pandas, polars, a structured array).
        name: for messages.

    Raises:
        GapError: it has no `t`, columns of unequal length, too few rows, numbers that are not finite, or time that
            does not increase.
    """
    if not is_table(table):
        raise GapError(f"{name}: {type(table).__name__} is no table, a mapping of names to arrays or a frame is needed")
    frame = _names(table)
    names = [str(c) for c in (table if frame is None else frame)]
    if "t" not in names:
        raise GapError(f"{name}: column 't' (time in seconds) is missing, there are {', '.join(names)}")
    out: dict[str, np.ndarray] = {}
    for column in ("t", *(c for c in names if c != "t")):
        try:
            given = table[column]
            if np.ma.is_masked(given):
                raise GapError(f"{name}: column '{column}', row {np.argmax(np.ma.getmaskarray(given))} is masked")
            given = np.asarray(given)
            if np.iscomplexobj(given):
                raise TypeError
            out[column] = np.array(given, dtype=float)
        except (TypeError, ValueError):
            raise GapError(f"{name}: column '{column}' does not consist of numbers") from None
        if out[column].shape != (len(out["t"]),) or len(out["t"]) < FEWEST:
            raise GapError(
                f"{name}: column '{column}' has shape {out[column].shape}, every one needs the rows of 't', "
                f"at least {FEWEST}"
            )
        bad = np.flatnonzero(~np.isfinite(out[column]))
        if len(bad):
            raise GapError(f"{name}: column '{column}', row {bad[0]} is {out[column][bad[0]]}, not a finite number")
    back = np.flatnonzero(np.diff(out["t"]) <= 0)
    if len(back):
        raise GapError(f"{name}: column 't', row {back[0] + 1}: time does not increase")
    return out


def _lines(path: Path) -> tuple[list[str], list[list[str]]]:
    """Names of the columns and the cells of every row, as many as there are names."""
    try:
        with path.open(newline="", encoding="utf-8-sig", errors="replace") as file:
            lines = [line for line in csv.reader(file) if line and not line[0].lstrip().startswith("#")]
    except csv.Error as error:
        raise GapError(f"{path}: not a CSV ({error})") from None
    if not lines:
        raise GapError(f"{path}: the file is empty, a header line and at least {FEWEST} rows are needed")
    header = [name.strip() for name in lines[0]]
    if header[0] != "t":
        raise GapError(f"{path}: the first column is '{header[0]}', it must be 't' (time in seconds)")
    doubled = {name for name in header if header.count(name) > 1}
    if doubled:
        raise GapError(f"{path}: column '{sorted(doubled)[0]}' appears twice in the header (row 1)")
    rows = lines[1:]
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            raise GapError(
                f"{path}: row {number} has {len(row)} cells, the header has {len(header)} columns "
                f"(column '{header[min(len(row), len(header) - 1)]}' is where it ends)"
            )
    if len(rows) < FEWEST:
        raise GapError(f"{path}: {len(rows)} rows of data, at least {FEWEST} are needed")
    return header, rows


def _quick(path: Path) -> dict[str, np.ndarray] | None:
    """A clean file, read without keeping its text; None where anything is wrong and a row has to be named."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = [name.strip() for name in file.readline().split(",")]
        if header[0] != "t" or len(set(header)) < len(header):
            return None
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                data = np.loadtxt(file, delimiter=",", ndmin=2, comments="#")
        except (ValueError, UserWarning):
            return None
    if data.shape[1:] != (len(header),) or len(data) < FEWEST or not np.isfinite(data).all():
        return None
    if (np.diff(data[:, 0]) <= 0).any():
        return None
    return {name: data[:, j] for j, name in enumerate(header)}


def _number(path: Path, column: str, row: int, cell: str) -> float:
    try:
        return float(cell) if cell.strip() else float("nan")
    except ValueError:
        raise GapError(f"{path}: column '{column}', row {row} is '{cell[:40]}', a number is needed") from None


def write_table(path: Path, columns: dict[str, np.ndarray]) -> None:
    """Write columns of equal length as a CSV that `read_table` reads back to 9 digits."""
    names = list(columns)
    data = np.stack([np.asarray(columns[name], dtype=float) for name in names], axis=1)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(path, data, delimiter=",", header=",".join(names), comments="", fmt="%.9g")

"""A gown in a file: a named cut with the numbers that were identified for the real cloth.

    format: caretree-gown-1
    base: medium                 # the cut, a name in `GOWNS`
    parameters:                  # those that are left out keep the base gown's value
      mass: {value: 0.43, low: 0.41, high: 0.46, unit: kg}
      ...

`low` and `high` bound the interval that the identification gives; they are kept for the reader and move nothing.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import CaretreeError
from ..extras import later
from ..yaml_text import load_yaml
from .gown import GOWNS, GownSpec

if TYPE_CHECKING:
    import yaml
else:
    yaml = later("yaml")

FORMAT = "caretree-gown-1"
UNITS = {
    "mass": "kg",
    "elastic": "N/m",
    "bending": "N/m",
    "damping": "N s/m",
    "friction": "1",
    "air_drag": "N s^2/m^4",
}  # what a file may say of a gown
_ZERO_IS_FINE = ("bending", "damping", "friction", "air_drag")


@dataclass(frozen=True, kw_only=True)
class GownFile:
    """What a gown file says.

    Attributes:
        base: name of the cut in `GOWNS`.
        values: parameter -> value in the unit of `UNITS`.
        intervals: parameter -> (low, high), for those that have one.
    """

    base: str
    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]

    def __post_init__(self) -> None:
        """Reject what no gown can have.

        Raises:
            CaretreeError: unknown gown or parameter, a value that is none, an interval that misses its value.
        """
        if self.base not in GOWNS:
            raise CaretreeError(f"unknown base gown '{self.base}'; there are {', '.join(GOWNS)}")
        for name, value in self.values.items():
            _check_known(name)
            least = "at least" if name in _ZERO_IS_FINE else "above"
            if not (0 <= value < float("inf")) or (value == 0 and name not in _ZERO_IS_FINE):
                raise CaretreeError(f"{name} is {value:g} {UNITS[name]}, a finite number {least} 0 is asked for")
        for name, (low, high) in self.intervals.items():
            if name not in self.values or not low <= self.values[name] <= high:
                raise CaretreeError(f"the interval {low:g} to {high:g} of {name} does not hold its value")

    @property
    def spec(self) -> GownSpec:
        """The gown, named after its base."""
        changes: dict[str, Any] = dict(self.values)
        return replace(GOWNS[self.base], name=f"{self.base} (identified)", **changes)


def write_gown(path: str | Path, gown: GownFile) -> Path:
    """Write a gown file, completely or not at all; returns its path."""
    path = Path(path)
    entries: dict[str, dict[str, Any]] = {}
    for name, value in gown.values.items():
        entries[name] = {"value": float(value)}
        if name in gown.intervals:
            entries[name] |= {"low": float(gown.intervals[name][0]), "high": float(gown.intervals[name][1])}
        entries[name]["unit"] = UNITS[name]
    part = path.with_name(path.name + ".part")
    part.write_text(
        yaml.safe_dump({"format": FORMAT, "base": gown.base, "parameters": entries}, sort_keys=False), encoding="utf-8"
    )
    os.replace(part, path)
    return path


def read_gown(path: str | Path) -> GownFile:
    """Read a gown file.

    Raises:
        CaretreeError: it is missing or cannot be used; one sentence that names the file.
    """
    path = Path(path)
    if not path.is_file():
        raise CaretreeError(f"{path}: there is no such gown file")
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        where = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None)
        what = f"this is not YAML{f': {problem}' if problem else ''}"
        raise CaretreeError(f"{path}{f':{where.line + 1}' if where else ''}: {what}") from error
    try:
        return _checked(content)
    except CaretreeError as error:
        raise CaretreeError(f"{path}: {error}") from None


def _check_known(name: object) -> None:
    if name not in UNITS:
        alike = difflib.get_close_matches(str(name), UNITS, n=1)
        meant = f"; {alike[0]} is meant?" if alike else ""
        raise CaretreeError(f"unknown parameter '{name}' of a gown; there are {', '.join(UNITS)}{meant}")


def _checked(content: object) -> GownFile:
    if not isinstance(content, Mapping) or content.get("format") != FORMAT:
        raise CaretreeError(f"this is no gown file, it must begin with `format: {FORMAT}`")
    strange = set(content) - {"format", "base", "parameters"}
    if strange:
        raise CaretreeError(f"unknown key '{min(map(str, strange))}'; there are format, base, parameters")
    entries = content.get("parameters")
    if not isinstance(entries, Mapping) or not isinstance(content.get("base"), str):
        raise CaretreeError("a gown file needs `base`, the name of a gown, and `parameters`")
    values, intervals = {}, {}
    for name, entry in entries.items():
        _check_known(name)
        numbers = entry if isinstance(entry, Mapping) else {"value": entry}
        if not set(numbers) <= {"value", "low", "high", "unit"} or "value" not in numbers:
            raise CaretreeError(f"parameter '{name}' needs `value`, and may have low, high and unit")
        if any(isinstance(v, bool) or not isinstance(v, int | float) for k, v in numbers.items() if k != "unit"):
            raise CaretreeError(f"value, low and high of '{name}' must be numbers")
        if numbers.get("unit", UNITS.get(name)) != UNITS.get(name):
            raise CaretreeError(f"'{name}' is given in {numbers['unit']}, it must be in {UNITS.get(name)}")
        values[name] = float(numbers["value"])
        if ("low" in numbers) != ("high" in numbers):
            raise CaretreeError(f"parameter '{name}' has one end of its interval only")
        if "low" in numbers:
            intervals[name] = (float(numbers["low"]), float(numbers["high"]))
    return GownFile(base=content["base"], values=values, intervals=intervals)

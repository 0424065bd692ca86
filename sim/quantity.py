"""Numbers as data: each with its unit, its meaning and where it comes from.

    @dataclass(frozen=True, kw_only=True)
    class PullTuning(Quantities):
        '''Numbers of the pull.'''

        speed: float = quantity(0.08, "m/s", "of the grip along the arm", "choice: leaves the base room to follow")

`PullTuning().speed` is a plain float; `rows(PullTuning())` gives the table that documentation and the command line
show, and `changed(PullTuning(), {"speed": 0.05})` a copy with other numbers.  A field may hold another such class.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar

from .errors import CaretreeError

_UNIT, _MEANING, _SOURCE = "unit", "meaning", "source"


class QuantityError(CaretreeError):
    """A number was set that does not exist, or to something it cannot be."""


def quantity(value: Any, unit: str, meaning: str, source: str) -> Any:
    """A field of a frozen dataclass that holds one number, or a tuple of them.

    Args:
        value: the default: float, int, bool, or a tuple of these.
        unit: SI unit without brackets (`m/s`), or `1` for shares, ratios and counts.
        meaning: what the number is, read after its name: "of the grip along the arm".
        source: where it comes from: `choice: why`, `measured: on what`, `standard: which`, a datasheet or a paper.

    Raises:
        QuantityError: one of the texts is empty.
    """
    for name, text in ((_UNIT, unit), (_MEANING, meaning), (_SOURCE, source)):
        if not text.strip():
            raise QuantityError(f"a quantity of {value!r} has no {name}")
    return field(default=value, metadata={_UNIT: unit, _MEANING: meaning, _SOURCE: source})


class Quantities:
    """Base of frozen dataclasses whose fields are quantities, or again `Quantities`."""


N = TypeVar("N", bound=Quantities)


@dataclass(frozen=True)
class Row:
    """One number as documentation shows it; `name` is dotted where tables are nested."""

    name: str
    value: Any
    unit: str
    meaning: str
    source: str


def rows(numbers: Quantities) -> list[Row]:
    """Every number of `numbers`, nested ones too, in the order of their declaration.

    Raises:
        QuantityError: a field is neither a quantity nor `Quantities`.
    """
    found: list[Row] = []
    for item in fields(numbers):  # pyright: ignore[reportArgumentType] every subclass is a dataclass
        value = getattr(numbers, item.name)
        if isinstance(value, Quantities):
            found += [replace(row, name=f"{item.name}.{row.name}") for row in rows(value)]
        elif _UNIT in item.metadata:
            found.append(Row(item.name, value, *(item.metadata[key] for key in (_UNIT, _MEANING, _SOURCE))))
        else:
            raise QuantityError(f"{type(numbers).__name__}.{item.name} is no quantity(value, unit, meaning, source)")
    return found


def changed(numbers: N, values: Mapping[str, Any], *, also: Sequence[str] = ()) -> N:
    """A copy of `numbers` with other `values` by (dotted) name.

    Args:
        numbers: to start from.
        values: by name.
        also: names that an error offers besides, set elsewhere.

    Raises:
        QuantityError: an unknown name, or a value of another type; the dataclass may refuse values itself.
    """
    known = {row.name: row for row in rows(numbers)}
    result = numbers
    for name, value in values.items():
        if name not in known:
            near = difflib.get_close_matches(name, [*known, *also], n=1)
            hint = f"; did you mean {near[0]}?" if near else f"; there are {', '.join([*known, *also])}"
            raise QuantityError(f"{type(numbers).__name__} has no number {name!r}{hint}")
        whole = f"{type(numbers).__name__}.{name}"
        number = _as(known[name].value, value, whole)
        if known[name].unit == "s" and _spans(known[name].value) and not _spans(number):
            raise QuantityError(f"{whole} is {value!r}, but a span of time in seconds is asked for")
        result = _replaced(result, name.split("."), number)
    return result


def _spans(number: Any) -> bool:
    """Whether a number, or each of several, is a span of time: something divides by it, or waits for it."""
    return all(map(_spans, number)) if isinstance(number, tuple) else 0.0 < number < math.inf


def _replaced(numbers: Any, path: list[str], value: Any) -> Any:
    inner = value if len(path) == 1 else _replaced(getattr(numbers, path[0]), path[1:], value)
    return replace(numbers, **{path[0]: inner})


def _as(default: Any, value: Any, name: str) -> Any:
    """`value` in the type of `default`."""
    if isinstance(default, tuple):
        if isinstance(value, (list, tuple)) and len(value) == len(default):
            return tuple(_as(one, other, name) for one, other in zip(default, value, strict=True))
        raise QuantityError(f"{name} is {value!r}, but {len(default)} numbers are asked for")
    if isinstance(default, bool):
        if isinstance(value, bool):
            return value
        raise QuantityError(f"{name} is {value!r}, but true or false is asked for")
    number = float_of(name, value)
    if isinstance(default, int):
        if not number.is_integer():
            raise QuantityError(f"{name} is {value!r}, but a whole number is asked for")
        return int(number)
    return number


def float_of(name: str, value: Any) -> float:
    """`value` as a float.

    Raises:
        QuantityError: it is no number; the message begins with `name`.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value:
        raise QuantityError(f"{name} is {value!r}, but a number is asked for")
    return float(value)

"""Constants as text and back, by the type that a port declares.

| type | text |
|---|---|
| text, Literal | as it is |
| bool | `true`, `false` |
| int, float | as Python writes it, so that no digit is lost |
| array of numbers, tuple | `1.05;-0.38;3.14` |
| numbers of a skill (`Quantities`) | `json:{"withdraw.min_rise": -1.0}`, those that differ from the port's own |
"""

from __future__ import annotations

import json
import math
import types
import typing
from typing import Any

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.quantity import Quantities, changed, rows
from ...skills.core.ports import type_name
from .document import nearest

JSON = "json:"


class ValueTextError(CaretreeError):
    """A constant that has no text, or a text that is no such constant."""


def is_pointer(text: str) -> bool:
    """Whether an attribute names a key, `{key}`, and is no constant."""
    return len(text) > 2 and text.startswith("{") and text.endswith("}")


def same(one: Any, other: Any) -> bool:
    """Whether two constants are the same in type and value."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return isinstance(one, np.ndarray) and isinstance(other, np.ndarray) and np.array_equal(one, other)
    return type(one) is type(other) and bool(one == other)


def to_text(value: Any, kind: Any, default: Any = None) -> str:
    """The text of a constant.

    Args:
        value: of the port.
        kind: that the port declares.
        default: of the port.

    Raises:
        ValueTextError: it has none.
    """
    try:
        text = _text(value, default)
        if text != text.strip() or is_pointer(text) or not same(from_text(text, kind, default), value):
            raise ValueTextError
    except ValueTextError:
        raise ValueTextError(f"a {type(value).__name__} such as {str(value)[:60]!r} cannot be written in XML") from None
    return text


def _text(value: Any, default: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(float(value) if isinstance(value, float) else int(value))
    if isinstance(value, np.ndarray) and value.ndim == 1:
        return ";".join(repr(float(each)) for each in value)
    if isinstance(value, tuple) and value:
        return ";".join(_text(each, None) for each in value)
    if isinstance(value, Quantities) and type(default) is type(value):
        usual = {row.name: row.value for row in rows(default)}
        return JSON + json.dumps({row.name: row.value for row in rows(value) if row.value != usual[row.name]})
    raise ValueTextError


def from_text(text: str, kind: Any, default: Any = None) -> Any:
    """The constant that `text` stands for where a port declares `kind`.

    Raises:
        ValueTextError: it stands for none.
    """
    origin = typing.get_origin(kind)
    if origin is typing.Literal:
        for option in typing.get_args(kind):
            if str(option) == text:
                return option
        raise ValueTextError(f"{text!r} is none of them: {nearest(text, map(str, typing.get_args(kind)))}")
    if origin in (typing.Union, types.UnionType):
        return _of_union(text, kind, default)
    if origin is tuple:
        return _tuple(text, typing.get_args(kind))
    plain = origin or kind
    if plain is Any or plain is str:
        return text
    if plain is bool and text in ("true", "false"):
        return text == "true"
    if plain in (int, float):
        return _number(text, plain)
    if plain is np.ndarray:
        return np.array([_number(part, float) for part in text.split(";")])
    if isinstance(plain, type) and issubclass(plain, Quantities):
        return _quantities(text, plain, default)
    raise ValueTextError(f"{text!r} is no {type_name(kind)}" + ("" if plain is bool else "; wire a {key} to it"))


def _number(text: str, kind: type) -> Any:
    try:
        value = kind(text)
    except ValueError:
        raise ValueTextError(f"{text!r} is no {'whole number' if kind is int else 'number'}") from None
    if math.isnan(value):  # infinity is a number: as a limit it means that there is none
        raise ValueTextError(f"{text!r} is no number")
    return value


def _of_union(text: str, kind: Any, default: Any) -> Any:
    """Numbers before text, or a text would take them all."""
    parts = sorted(typing.get_args(kind), key=lambda part: part in (str, Any))
    for part in parts:
        try:
            return from_text(text, part, default)
        except ValueTextError:
            continue
    raise ValueTextError(f"{text!r} is no {type_name(kind)}")


def _tuple(text: str, kinds: tuple[Any, ...]) -> tuple[Any, ...]:
    texts = text.split(";")
    if len(kinds) == 2 and kinds[1] is Ellipsis:
        kinds = (kinds[0],) * len(texts)
    if len(kinds) != len(texts):
        raise ValueTextError(f"{text!r} has {len(texts)} parts, but {len(kinds)} are asked for")
    return tuple(from_text(part, kind) for part, kind in zip(texts, kinds, strict=True))


def _quantities(text: str, kind: type, default: Any) -> Any:
    usual = default if isinstance(default, kind) else kind()
    try:
        values = json.loads(text.removeprefix(JSON)) if text.startswith(JSON) else None
    except (ValueError, RecursionError):
        values = None
    if not isinstance(values, dict):
        example = next((row for row in rows(usual)), None)
        shown = f'json:{{"{example.name}": {json.dumps(example.value)}}}' if example else "json:{}"
        raise ValueTextError(f"{text!r} does not set numbers of {kind.__name__}, as {shown} does")
    return changed(usual, values)

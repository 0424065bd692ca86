"""Typed ports: what a skill reads and writes, declared on the class, bound to a key or a constant when built.

    class Grasp(Skill):
        target = Input(GraspPoint, doc="where to close the fingers")  # Grasp(..., target=Key("collar")) or a GraspPoint
        force = Input(float, unit="N", doc="of the grip at most", default=20.0)
        held = Output(GraspPoint, doc="where the cloth is held")  # Grasp(..., held=Key("held"))

An input read before it was written, or a value of the wrong type, raises PortError, NaN too; `caretree check` finds
both before anything moves.  Outputs are unset whenever their skill is entered, so no skill sees stale data.
`caretree skills NAME` prints types, units and documentation.
"""

from __future__ import annotations

import types
import typing
from functools import cache
from typing import Any, Generic, TypeVar, overload

import numpy as np

from ...sim.errors import CaretreeError

T = TypeVar("T")
_REQUIRED: Any = object()
# what py_trees and `Skill` set on every leaf, beside what their classes have
OF_EVERY_SKILL = frozenset(
    {"name", "context", "world", "bindings", "failure", "status", "parent", "children", "id", "logger", "iterator"}
    | {"feedback_message", "blackboards", "qualified_name", "blackbox_level"}
)


class PortError(CaretreeError):
    """A port is wired wrongly, unset, or holds a value of another type."""


class Key:
    """Name of a value on the board, given to a skill in place of a constant.

    Attributes:
        name: on the board.
        word: as its author wrote it, for messages.
        place: where that stands, as file:line; empty where it was built by Python.
    """

    def __init__(self, name: str) -> None:
        if not isinstance(name, str) or not name.isidentifier():
            raise PortError(f"key {name!r} is not an identifier such as 'collar' or 'arm_left'")
        self.name, self.word, self.place = name, repr(name), ""

    def written_as(self, word: str, place: str) -> Key:
        """The same key, told as its author wrote it."""
        key = Key(self.name)
        key.word, key.place = word, place
        return key

    @property
    def told(self) -> str:
        """How messages call it."""
        return f"{self.word} at {self.place}" if self.place else self.word

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Key) and other.name == self.name

    def __hash__(self) -> int:
        return hash(("Key", self.name))

    def __repr__(self) -> str:
        return f"Key({self.name!r})"


def type_name(kind: Any) -> str:
    """How a port type is written in a message."""
    return kind.__name__ if isinstance(kind, type) else str(kind).replace("typing.", "")


@cache
def _origin(kind: Any) -> Any:
    return typing.get_origin(kind)  # asked at every read and write


def conforms(value: object, kind: Any) -> bool:
    """Whether `value` may be written where `kind` is declared (a class, a union, a Literal or Any)."""
    if kind is Any:
        return True
    origin = _origin(kind)
    if origin is typing.Literal:
        return any(value == allowed and type(value) is type(allowed) for allowed in typing.get_args(kind))
    if origin in (typing.Union, types.UnionType):
        return any(conforms(value, part) for part in typing.get_args(kind))
    plain = origin or kind
    if plain is float:  # as in annotations, an int serves where a float is asked for; a bool does not
        return isinstance(value, (float, int)) and not isinstance(value, bool)
    if plain is int and isinstance(value, bool):
        return False
    return value is None if plain is None else isinstance(value, plain)


def assignable(source: Any, target: Any) -> bool:
    """Whether everything declared as `source` may flow into an input declared as `target`."""
    if Any in (source, target) or source == target:
        return True
    source_origin, target_origin = typing.get_origin(source), typing.get_origin(target)
    if source_origin in (typing.Union, types.UnionType):
        return all(assignable(part, target) for part in typing.get_args(source))
    if source_origin is typing.Literal:
        return all(conforms(value, target) for value in typing.get_args(source))
    if target_origin in (typing.Union, types.UnionType):
        return any(assignable(source, part) for part in typing.get_args(target))
    if target_origin is typing.Literal:
        return False
    source_plain, target_plain = source_origin or source, target_origin or target
    if source_plain is int and target_plain is float:
        return True
    return isinstance(source_plain, type) and isinstance(target_plain, type) and issubclass(source_plain, target_plain)


class Board:
    """Values by key for one run; never shared between runs."""

    def __init__(self) -> None:
        self._values: dict[str, Any] = {}

    def __contains__(self, name: str) -> bool:
        return name in self._values

    def get(self, name: str) -> Any:
        """The value of `name`.

        Raises:
            PortError: nothing wrote it, or what wrote it has been started again since.
        """
        try:
            return self._values[name]
        except KeyError:
            known = ", ".join(sorted(self._values)) or "nothing"
            raise PortError(f"key {name!r} has not been written; the board holds {known}") from None

    def set(self, name: str, value: Any) -> None:
        """Write `value` under `name`."""
        self._values[name] = value

    def unset(self, name: str) -> None:
        """Forget `name`; nothing happens when it is not there."""
        self._values.pop(name, None)

    def clear(self) -> None:
        """Forget everything."""
        self._values.clear()

    def keys(self) -> frozenset[str]:
        """Names that hold a value now."""
        return frozenset(self._values)


def _is_nan(value: object) -> bool:
    """Whether a number, or one of an array, is none."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind == "f" and bool(np.isnan(value).any())
    return isinstance(value, float) and value != value


class _Port(Generic[T]):
    """Common part of inputs and outputs: a name, a type, a unit, a sentence, and a place in the owner's `bindings`."""

    name: str

    def __init__(self, kind: type[T] | Any, *, unit: str = "", doc: str = "") -> None:
        self.kind = kind
        self.unit = unit
        self.doc = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def _check(self, owner: Any, value: Any) -> None:
        if not conforms(value, self.kind):
            raise PortError(
                f"{type(owner).__name__}.{self.name} takes {type_name(self.kind)}, "
                f"but was given {type(value).__name__} {str(value)[:60]!r}"
            )

    @overload
    def __get__(self, owner: None, kind: type) -> _Port[T]: ...
    @overload
    def __get__(self, owner: object, kind: type) -> T: ...
    def __get__(self, owner: Any, kind: type) -> Any:
        if owner is None:
            return self
        bound = owner.bindings[self.name]
        value = owner.context.board.get(bound.name) if isinstance(bound, Key) else bound
        if value is _REQUIRED:
            raise PortError(f"{type(owner).__name__}.{self.name} has not been written yet")
        self._check(owner, value)
        return value


class Input(_Port[T]):
    """A value a skill reads: a `Key` or a constant.

    Args:
        kind: a class, a union, a Literal or Any.
        unit: SI unit of a number, or of the numbers of an array, frame included: `m, map`.
        doc: what it is, one clause.
        default: constant used when nothing is given; without it the input must be given.
    """

    def __init__(self, kind: type[T] | Any, *, unit: str = "", doc: str = "", default: T | None = _REQUIRED) -> None:
        super().__init__(kind, unit=unit, doc=doc)
        self.default = default

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return self.default is _REQUIRED

    def _check(self, owner: Any, value: Any) -> None:
        if value is not None or self.default is not None:  # a default of None makes the input optional
            super()._check(owner, value)

    def __set__(self, owner: Any, value: T) -> None:
        raise PortError(f"{type(owner).__name__}.{self.name} is an input and cannot be written")

    def bind(self, owner: Any, given: Any) -> Any:
        """The binding for `given` (a Key, a constant, or nothing), checked."""
        value = self.default if given is _REQUIRED else given
        if value is _REQUIRED:
            raise PortError(f"{type(owner).__name__} needs {self.name}={type_name(self.kind)} or a Key")
        if not isinstance(value, Key):
            self._check(owner, value)
            if _is_nan(value):
                raise PortError(f"{type(owner).__name__}.{self.name} is {value}, which is no number")
            if self.unit == "s" and isinstance(value, int | float) and value < 0.0:
                raise PortError(f"{type(owner).__name__}.{self.name} is {value} s, which is no span of time")
        return value


class Output(_Port[T]):
    """A value a skill writes, under a `Key`; without one it stays on the skill."""

    def __set__(self, owner: Any, value: T) -> None:
        self._check(owner, value)
        bound = owner.bindings[self.name]
        if isinstance(bound, Key):
            owner.context.board.set(bound.name, value)
        else:
            owner.bindings[self.name] = value

    def bind(self, owner: Any, given: Any) -> Any:
        """The binding for `given`: a Key, or nothing."""
        if given is not _REQUIRED and not isinstance(given, Key):
            raise PortError(f"{type(owner).__name__}.{self.name} is an output and takes a Key, not {given!r}")
        return given

    def reset(self, owner: Any) -> None:
        """Forget what was written."""
        bound = owner.bindings[self.name]
        if isinstance(bound, Key):
            owner.context.board.unset(bound.name)
        else:
            owner.bindings[self.name] = _REQUIRED


@cache
def ports_of(kind: type) -> tuple[tuple[str, Input[Any] | Output[Any]], ...]:
    """Ports declared by a class and its bases, sorted by name; kept, as every leaf of a tree is asked for its own."""
    found = _attributes_of(kind)
    return tuple((name, found[name]) for name in sorted(found) if isinstance(found[name], (Input, Output)))


def _attributes_of(kind: type) -> dict[str, Any]:
    return {name: each for base in reversed(kind.__mro__) for name, each in vars(base).items()}


def refuse_taken_names(kind: type) -> None:
    """Refuse ports that are called as what every skill has.

    Raises:
        PortError: one is.
    """
    before = _attributes_of(kind.__mro__[1])
    for name, port in ports_of(kind):
        if name in OF_EVERY_SKILL or not isinstance(before.get(name, port), (Input, Output)):
            raise PortError(f"{kind.__name__}.{name}: every skill has {name!r} of its own, call the port otherwise")


def bind_ports(owner: Any, given: dict[str, Any]) -> dict[str, Any]:
    """Bindings of all ports of `owner` by name.

    Raises:
        PortError: an unknown port, a missing input, a constant of the wrong type.
    """
    ports = dict(ports_of(type(owner)))
    unknown = sorted(set(given) - set(ports))
    if unknown:
        raise PortError(f"{type(owner).__name__} has no port {unknown[0]!r}; it has {', '.join(ports) or 'none'}")
    return {name: port.bind(owner, given.get(name, _REQUIRED)) for name, port in ports.items()}

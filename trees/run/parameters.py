"""Parameters of a task: arguments of its `build` that a run may set, each with type, unit, bounds and meaning.

    def build(
        context: Context,
        arm: Annotated[Side, Parameter("whose arm is lifted")] = "right",
        seconds: Annotated[float, Parameter("how long it is held up", unit="s", low=5.0, high=60.0)] = 10.0,
    ) -> Behaviour:

    caretree run wash --set seconds=20

The type of the annotation is one of float, int, bool, str and Literal, and the default is a value of it.
"""

from __future__ import annotations

import difflib
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

from ...sim.errors import CaretreeError
from .catalogue import all_skills

PLAIN = {float: "a number", int: "a whole number", bool: "true or false", str: "a text"}


class ParameterError(CaretreeError):
    """A parameter that a task does not have, a value that it does not take, or a wrong declaration."""


@dataclass(frozen=True)
class Parameter:
    """How an argument of `build` is declared.

    Attributes:
        doc: what it is, one line.
        unit: SI unit without brackets; empty for texts and truth values.
        low, high: bounds of a number; None for none.
    """

    doc: str
    unit: str = ""
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class BuildParameter:
    """One parameter of one task.

    Attributes:
        name: of the argument.
        kind: float, int, bool, str, or the values of a Literal.
        default: value where a run sets none.
        declared: its doc, unit and bounds.
    """

    name: str
    kind: type | tuple[Any, ...]
    default: Any
    declared: Parameter

    def value(self, given: Any) -> Any:
        """`given` as a value of this parameter.

        Raises:
            ParameterError: it is none; says what is asked for.
        """
        if isinstance(self.kind, tuple):
            fits = given in self.kind
        elif self.kind is float:
            fits = isinstance(given, (int, float)) and not isinstance(given, bool) and math.isfinite(given)
        else:
            fits = isinstance(given, self.kind) and (self.kind is bool or not isinstance(given, bool))
        low, high = self.declared.low, self.declared.high
        if fits and self.kind in (float, int):
            fits = (low is None or given >= low) and (high is None or given <= high)
        if not fits:
            raise ParameterError(f"parameter {self.name} is {given!r}, but {self.asked()} is asked for")
        return float(given) if self.kind is float else given

    def asked(self) -> str:
        """What it takes, in words: `a number from 5 to 60 s`."""
        if isinstance(self.kind, tuple):
            return " or ".join(map(str, self.kind))
        low, high, unit = self.declared.low, self.declared.high, self.declared.unit
        bounds = "".join(f" {word} {value:g}" for word, value in (("from", low), ("to", high)) if value is not None)
        in_unit = (f" {unit}" if bounds else f" in {unit}") if unit else ""
        return f"{PLAIN[self.kind]}{bounds}{in_unit}"

    def line(self) -> str:
        """For a list: name, default, what it takes, what it is."""
        return f"{self.name} = {self.default}  ({self.asked()}): {self.declared.doc}"


def parameters_of(build: Callable[..., Any]) -> dict[str, BuildParameter]:
    """Those arguments of a `build` that are declared as parameters, by name.

    Raises:
        ParameterError: a type is none of those named above, or the default is missing or no value of it.
    """
    try:
        hints = get_type_hints(build, include_extras=True)
    except (NameError, TypeError, AttributeError):  # annotations of the author's own that only a type checker reads
        return {}
    found: dict[str, BuildParameter] = {}
    for name, argument in inspect.signature(build).parameters.items():
        hint = hints.get(name)
        declared = [each for each in get_args(hint)[1:] if isinstance(each, Parameter)]
        if get_origin(hint) is not Annotated or not declared:
            continue
        kind = get_args(hint)[0]
        kind = get_args(kind) if get_origin(kind) is Literal else kind
        if not isinstance(kind, tuple) and kind not in PLAIN:
            said = kind.__name__ if isinstance(kind, type) else kind
            raise ParameterError(f"parameter {name} is a {said}, but float, int, bool, str or a Literal is asked for")
        if argument.default is inspect.Parameter.empty:
            raise ParameterError(f"parameter {name} has no default")
        low, high = declared[0].low, declared[0].high
        if low is not None and high is not None and low > high:
            raise ParameterError(f"parameter {name} goes from {low:g} to {high:g}, where nothing lies between")
        parameter = BuildParameter(name, kind, argument.default, declared[0])
        parameter.value(argument.default)
        found[name] = parameter
    return found


def all_values(parameters: Mapping[str, BuildParameter], given: Mapping[str, Any], task: str) -> dict[str, Any]:
    """The value of each parameter: the given one, or its default.

    Raises:
        ParameterError: the task has no such parameter, or a value will not do.
    """
    for name in given:
        if name not in parameters:
            there = ", ".join(parameters) or "none"
            alike = difflib.get_close_matches(name, list(parameters), n=1)
            meant = f"; {alike[0]} is meant?" if alike else ""
            if name in all_skills():
                meant = f"; it is a skill, whose numbers are set as {name}.NUMBER=VALUE, or {name}: {{NUMBER: VALUE}}"
            raise ParameterError(f"task {task!r} has no parameter {name!r}; it has {there}{meant}")
    return {name: each.value(given.get(name, each.default)) for name, each in parameters.items()}

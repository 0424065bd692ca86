"""The leaves that a tree in XML may have: skills and conditions, of the package and of a task's own Python."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

from ...sim.errors import CaretreeError
from ...skills.core.ports import Input, ports_of, type_name
from ...skills.core.skill import Skill
from ..nodes.condition import inputs_of
from ..run.catalogue import all_skills
from .forms import BY_TAG, PortModel
from .values import ValueTextError, to_text

REASON = "reason"  # the attribute of a condition


def identifier(function: Callable[..., object]) -> str:
    """How a function is called as a condition in XML: `chest_covered` -> `ChestCovered`."""
    return "".join(word.capitalize() for word in str(getattr(function, "__name__", "")).split("_"))


@dataclass(frozen=True)
class Vocabulary:
    """Leaves by their name in XML.

    Attributes:
        skills: classes.
        conditions: functions, called with the context and their inputs.
    """

    skills: Mapping[str, type[Skill]] = field(default_factory=dict)
    conditions: Mapping[str, Callable[..., object]] = field(default_factory=dict)

    @classmethod
    def of(cls, modules: Iterable[ModuleType] = ()) -> Vocabulary:
        """Those of the package, and of modules: their skills, and the functions that their `CONDITIONS` name.

        Raises:
            CaretreeError: a module's CONDITIONS are no functions, or two leaves have one name.
        """
        skills: dict[str, type[Skill]] = {kind.__name__: kind for kind in all_skills().values()}
        conditions: dict[str, Callable[..., object]] = {}
        for module in modules:
            for kind in vars(module).values():
                if isinstance(kind, type) and issubclass(kind, Skill) and kind is not Skill:
                    _add(skills, kind.__name__, kind, module)
            named = getattr(module, "CONDITIONS", ())
            if not isinstance(named, tuple) or not all(callable(each) and identifier(each) for each in named):
                raise CaretreeError(f"{module.__file__}:1: CONDITIONS is a tuple of functions: CONDITIONS = (fits,)")
            for test in named:
                _add(conditions, identifier(test), test, module)
        if both := sorted((skills.keys() & conditions.keys()) | (BY_TAG.keys() & (skills.keys() | conditions.keys()))):
            raise CaretreeError(f"two nodes are called {both[0]} in XML: a leaf needs another name")
        return cls(skills, conditions)

    def names(self) -> list[str]:
        """All leaves and other nodes that a file may name."""
        return sorted([*self.skills, *self.conditions, *BY_TAG])


def _add(found: dict[str, Any], name: str, value: Any, module: ModuleType) -> None:
    if found.setdefault(name, value) is not value:
        raise CaretreeError(f"{module.__file__}:1: there is another {name} already; in XML its name must be its own")


def ports_of_skill(kind: type[Skill]) -> list[PortModel]:
    """The ports of a skill as the palette shows them."""
    models = []
    for name, port in ports_of(kind):
        doc = f"{port.doc}{f' [{port.unit}]' if port.unit else ''}"
        is_input = isinstance(port, Input)
        default = _default(port) if isinstance(port, Input) else None
        direction = "input_port" if is_input else "output_port"
        models.append(PortModel(name, doc, type_name(port.kind), default, direction))
    return models


def _default(port: Input[Any]) -> str | None:
    if port.required or port.default is None:
        return None
    try:
        return to_text(port.default, port.kind, port.default)
    except ValueTextError:
        return None


def ports_of_condition(test: Callable[..., object]) -> list[PortModel]:
    """What a condition is given, as the palette shows it."""
    given = [PortModel(name, "", type_name(kind)) for name, kind in inputs_of(test).items()]
    return [*given, PortModel(REASON, "that it fails with", default="PRECONDITION")]

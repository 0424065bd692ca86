"""`caretree skills [NAME]`: the leaves there are; of one its ports, its reasons to fail and its numbers."""

from __future__ import annotations

import argparse
import difflib
import inspect
import textwrap

from ...sim.errors import CaretreeError
from ...sim.quantity import Quantities, rows
from ...skills.core.ports import Input, Output, ports_of, type_name
from ...skills.core.settings import TUNING, setting_name
from ...skills.core.skill import Skill
from ..run.catalogue import all_skills

WIDTH = 110  # characters of a line


def main(options: argparse.Namespace) -> int:
    """Print the list, or one skill.

    Raises:
        CaretreeError: there is no skill of that name.
    """
    known = all_skills()
    if options.name is None:
        for name, kind in known.items():
            print(f"{name:22s} {_summary(kind)}")
        return 0
    kind = known.get(options.name) or {found.__name__: found for found in known.values()}.get(options.name)
    if kind is None:
        near = difflib.get_close_matches(options.name, known, n=1)
        hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
        raise CaretreeError(f"no skill is called {options.name!r}; {hint}")
    print("\n".join(described(kind)))
    return 0


def described(kind: type[Skill]) -> list[str]:
    """Lines that say what a skill does, reads, writes, fails with, and which numbers it has."""
    lines = [f"{kind.__name__}  (from {kind.__module__} import {kind.__name__})", ""]
    lines += inspect.cleandoc(kind.__doc__ or "").splitlines()
    ports = list(ports_of(kind))
    for title, which in (("Inputs", Input), ("Outputs", Output)):
        mine = [(name, port) for name, port in ports if isinstance(port, which) and name != TUNING]
        if mine:
            lines += ["", f"{title}:"]
            for name, port in mine:
                lines += _wrapped(name, _port(port))
    lines += ["", "Fails with:"]
    for reason in kind.reasons:
        lines += _wrapped(reason.name, reason.value)
    numbers = next((port.default for name, port in ports if name == TUNING and isinstance(port, Input)), None)
    if isinstance(numbers, Quantities):
        lines += ["", f"Numbers (--set {setting_name(kind)}.NUMBER=VALUE; inputs that are numbers too):"]
        for row in rows(numbers):
            lines += _wrapped(row.name, f"{_number(row.value)}{_unit(row.unit)}: {row.meaning} ({row.source})")
    return lines


def _port(port: Input | Output) -> str:
    text = f"{type_name(port.kind)}{f' [{port.unit}]' if port.unit else ''}: {port.doc}"
    if isinstance(port, Input) and not port.required:
        text += f" (default {_number(port.default)})"
    return text


def _number(value: object) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(_number(one) for one in value)})"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" {unit}"


def _wrapped(name: str, text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=f"  {name:20s} ", subsequent_indent=" " * 23)


def _summary(kind: type) -> str:
    return inspect.cleandoc(kind.__doc__ or "").partition("\n")[0]

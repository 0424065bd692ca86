"""Stages that a task names, so that one of them, or a span, can be run alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ...skills.core.context import Context


@dataclass(frozen=True)
class TaskStage:
    """One stage of a task.

    Attributes:
        build: makes its part of the tree.
        begins: name of the world's initial state from which it can be run alone
            (`sim.abilities.SupportsInitialStates`); empty where any will do.
    """

    build: Callable[[Context], Behaviour]
    begins: str = ""


def span_of(names: Iterable[str], text: str) -> tuple[str, ...]:
    """Those of a task's stages that `text` asks for: one (`dress`), or all from one to another (`dress-spread`).

    Raises:
        CaretreeError: it names no stage, or a span that runs backwards.
    """
    known = list(names)
    first, dash, last = text.partition("-")
    last = last if dash else first
    if first not in known or last not in known[known.index(first) :]:
        spans = f", and spans such as {known[0]}-{known[1]}" if len(known) > 1 else ""
        raise CaretreeError(f"no stage {text!r}; there are {', '.join(known)}{spans}")
    return tuple(known[known.index(first) : known.index(last) + 1])

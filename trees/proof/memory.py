"""What the nodes of a tree were at the points of the way that an exploration follows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour

from .quick_nodes import REMEMBERING
from .stub import Stub

# Attributes of every node that no tick changes, or that nobody reads again.
FIXED = frozenset(vars(py_trees.behaviours.Success("any"))) - {"status", "feedback_message"} | {
    "context",
    "tick",
    "stop",
}
State = dict[str, Any]


class Memory:
    """Every node as it was at the last point, and what it takes to go back to an earlier one.

    A point keeps what those nodes were before it that had changed by then, so that points and ways back cost as much as
    was changed, not as much as the tree is large.  Points that one can go back to lie on the way to the last one.

    Args:
        nodes: of the tree.
        changed: nodes that are no longer as they were at the last point; whoever changes one puts it there.
    """

    def __init__(self, nodes: Iterable[Behaviour], changed: set[Behaviour]) -> None:
        self._changed = changed
        self._attributes = {node: (vars(node), _changing(node)) for node in nodes}
        self._restore = {node: vars(node).update for node in self._attributes}
        self._states: dict[Behaviour, State] = {}  # at the last point
        self._before: list[dict[Behaviour, State]] = []  # of each point, what has changed on the way to it
        for node, (now, names) in self._attributes.items():
            self._states[node] = {name: now[name] for name in names}

    def keep(self) -> int:
        """Have a point here; its number is for `go_back`."""
        states, before = self._states, {}
        for node in self._changed:
            now, names = self._attributes[node]
            before[node] = states[node]
            states[node] = {name: now[name] for name in names}
        self._changed.clear()
        self._before.append(before)
        return len(self._before)

    def go_back(self, point: int) -> None:
        """Make every node what it was at this point, which is the last one from now on."""
        back: dict[Behaviour, State] = {}
        while len(self._before) > point:  # later points first: what was before the earliest is what counts
            back |= self._before.pop()
        self._states |= back
        for node in self._changed | back.keys():
            self._restore[node](self._states[node])
        self._changed.clear()


def _changing(node: Behaviour) -> tuple[str, ...]:
    """Names of all that a tick may change of a node."""
    if type(node) is Stub:
        return "status", "failure"
    if type(node) in REMEMBERING:
        return "status", "current_child"
    return tuple(name for name in vars(node) if name not in FIXED)

"""Sequences and fallbacks of py_trees as they tick, without their log and without a generator for each.

An exploration ticks little else.  Only nodes that remember which child runs are ticked like this.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

RUNNING, SUCCESS, FAILURE, INVALID = Status.RUNNING, Status.SUCCESS, Status.FAILURE, Status.INVALID
REMEMBERING = (py_trees.composites.Selector, py_trees.composites.Sequence)

Tick = Callable[[], Iterable[Behaviour]]
Stop = Callable[..., None]


def remembers(node: Behaviour) -> bool:
    """Whether it is a sequence or a fallback of py_trees that goes on with the child that runs."""
    return type(node) in REMEMBERING and getattr(node, "memory", False) is True


def quickened(node: py_trees.composites.Composite, change: Callable[[], None]) -> tuple[Tick, Stop]:
    """What `tick` and `stop` of a node that `remembers` do; the tick is over when it returns, and yields nothing.

    Args:
        node: of the tree.
        change: called before the node changes.
    """
    children: list[Any] = node.children

    def stop(new_status: Status = INVALID) -> None:
        change()
        if new_status is INVALID:
            node.current_child = None
            _invalidate(children)
        node.status = new_status

    def tick_sequence() -> Iterable[Behaviour]:
        change()
        going = node.status is RUNNING
        if not going:
            _invalidate(children)
        for child in children[children.index(node.current_child) :] if going else children:
            node.current_child = child
            status = _ticked(child)
            if status is not SUCCESS:
                node.status = status
                return ()
        node.status = SUCCESS
        return ()

    def tick_selector() -> Iterable[Behaviour]:
        change()
        if node.status is not RUNNING:
            node.current_child = children[0] if children else None
        first = children.index(node.current_child) if children else 0
        _invalidate(children[:first])
        for n, child in enumerate(children[first:], first):
            status = _ticked(child)
            if status is not FAILURE:
                if child is not node.current_child:  # what is left from an earlier round
                    _invalidate(children[n + 1 :])
                node.current_child, node.status = child, status
                return ()
        node.current_child, node.status = children[-1] if children else None, FAILURE
        return ()

    return (tick_selector if isinstance(node, py_trees.composites.Selector) else tick_sequence), stop


def _invalidate(children: list[Any]) -> None:
    for child in children:
        if child.status is not INVALID:
            child.stop(INVALID)


def _ticked(child: Behaviour) -> Status:
    for _ in child.tick():
        pass
    return child.status

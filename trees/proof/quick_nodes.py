"""Inner nodes as they tick, without a log, without a generator for each and without an iterator after each stop.

An exploration ticks little else.  Of py_trees' own only sequences and fallbacks that remember which child runs are
ticked like this, of this project's those that go on with it and do nothing else in a tick.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ..nodes.decorators import FailSafe, RecoverBy, Retry, Stage, Timeout, Wrapper

RUNNING, SUCCESS, FAILURE, INVALID = Status.RUNNING, Status.SUCCESS, Status.FAILURE, Status.INVALID
REMEMBERING = (py_trees.composites.Selector, py_trees.composites.Sequence)
RESUMING = (FailSafe, RecoverBy, Retry, Stage, Timeout)

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


def quickened_wrapper(node: Wrapper, begin: Callable[[], None], change: Callable[[], None]) -> tuple[Tick, Stop]:
    """What `tick` and `stop` of one of the `RESUMING` do; the tick is over when it returns, and yields nothing.

    Args:
        node: of the tree.
        begin: called before a tick with which the node begins.
        change: called before the node changes otherwise.
    """
    children: list[Any] = node.children

    def stop(new_status: Status = INVALID) -> None:
        change()
        for child in children:
            if child.status is RUNNING:
                child.stop(INVALID)
        if new_status is INVALID:
            node.current_child = None
            _invalidate(children)
        node.terminate(new_status)
        node.status = new_status

    def tick() -> Iterable[Behaviour]:
        if node.status is RUNNING:
            change()
        else:
            begin()
            _invalidate(children)
            node.failure, node.current_child = None, children[0]
            node.initialise()
        status = _end_of(node.advance())
        if status is not RUNNING:
            node.stop(status)
        node.status = status
        return ()

    return tick, stop


def _end_of(steps: Generator[Behaviour, None, Status]) -> Status:
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def _invalidate(children: list[Any]) -> None:
    for child in children:
        if child.status is not INVALID:
            child.stop(INVALID)


def _ticked(child: Behaviour) -> Status:
    for _ in child.tick():
        pass
    return child.status

"""Breakpoints: a run stands still before a node begins or after it has ended, until somebody lets it go on.

| asked of | what happens |
|---|---|
| a simulated world | the tick is held where it is, and the world's time with it |
| a robot | refused: its time cannot be held |

While the time of a world stands still nothing in it falls, slips or goes on moving, and the trace is the same as
without the pause.  A robot would go on with its last command, or hold an arm, with nobody in control.

A pause ends when somebody lets it go on, removes or disables the breakpoint, has asked nothing for `PATIENCE`, or when
the run is told to stop: the safe stop is never held up, nor is the branch that makes safe after one.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...sim.scripted.clock import SteppedClock
from ..run.runner import Run
from .protocol import Hook, Position, ProtocolError, Unlock

PATIENCE = 5.0  # [s] wall time without any request after which nobody is there, as in BehaviorTree.CPP
NAP = 0.05  # [s] wall time between two looks at whether the run has been told to stop


class Breakpoints:
    """Those of one run.  They are set by other threads than the run's, which alone is held.

    Args:
        run: before its first tick.
        nodes: by their numbers.
        reached: called with the node's number, in the run's thread, as soon as a breakpoint holds it.
    """

    def __init__(self, run: Run, nodes: Mapping[int, Behaviour], reached: Callable[[int, Behaviour], None]) -> None:
        self._run = run
        self._nodes = nodes
        self._reached = reached
        self._hooks: dict[tuple[int, Position], Hook] = {}
        self._unlocked: set[tuple[int, Position]] = set()
        self._changed = threading.Condition()
        self._heard = time.monotonic()

    def hear(self) -> None:
        """Somebody is there."""
        self._heard = time.monotonic()

    def insert(self, hook: Hook) -> None:
        """Set a breakpoint, or change the one that is there.

        Raises:
            ProtocolError: there is no such node, or the world's time cannot be held.
        """
        if not isinstance(self._run.world.clock, SteppedClock):
            raise ProtocolError("a robot's time cannot be held: breakpoints are for simulated worlds")
        node = self._node(hook.uid)
        with self._changed:
            self._hooks[hook.uid, hook.position] = hook
            node.tick = _held(node, self._stop)  # a tick that goes on already is not held
            self._changed.notify_all()

    def remove(self, uid: int, position: Position) -> None:
        """Forget a breakpoint; what it holds goes on.

        Raises:
            ProtocolError: there is none.
        """
        node = self._node(uid)
        with self._changed:
            if self._hooks.pop((uid, position), None) is None:
                raise ProtocolError(f"node {uid} has no breakpoint there")
            if not any(self._nodes[each] is node for each, _ in self._hooks):
                vars(node).pop("tick", None)
            self._changed.notify_all()

    def remove_all(self) -> None:
        """Forget all of them."""
        for uid, position in list(self._hooks):
            self.remove(uid, position)

    def disable_all(self) -> None:
        """Let none of them count, but keep them."""
        with self._changed:
            self._hooks = {place: replace(hook, enabled=False) for place, hook in self._hooks.items()}
            self._changed.notify_all()

    def unlock(self, word: Unlock) -> None:
        """Let go on what a breakpoint holds.

        Raises:
            ProtocolError: there is no such breakpoint.
        """
        place = (word.uid, word.position)
        self._node(word.uid)
        with self._changed:
            if place not in self._hooks:
                raise ProtocolError(f"node {word.uid} has no breakpoint there")
            if word.remove:
                self._hooks[place] = replace(self._hooks[place], once=True)
            self._unlocked.add(place)
            self._changed.notify_all()

    def hooks(self) -> list[Hook]:
        """All of them."""
        with self._changed:
            return list(self._hooks.values())

    def _node(self, uid: int) -> Behaviour:
        try:
            return self._nodes[uid]
        except KeyError:
            raise ProtocolError(f"there is no node {uid}; they are numbered from 1 to {len(self._nodes)}") from None

    def _stop(self, node: Behaviour, position: Position) -> None:
        """Hold the run's thread while a breakpoint of `node` on this side asks for it."""
        for place in [each for each in list(self._hooks) if self._nodes[each[0]] is node and each[1] is position]:
            if not self._counts(place):
                continue
            self._unlocked.discard(place)
            with self._run.aside():
                self._reached(place[0], node)
                with self._changed:
                    while place not in self._unlocked and self._counts(place):
                        self._changed.wait(NAP)
                hook = self._hooks.get(place)
            if hook is not None and hook.once and place in self._unlocked:
                self.remove(*place)

    def _counts(self, place: tuple[int, Position]) -> bool:
        hook = self._hooks.get(place)
        listened = time.monotonic() - self._heard < PATIENCE
        return hook is not None and hook.enabled and listened and not self._run.stopping


def _held(node: Behaviour, stop: Callable[[Behaviour, Position], None]) -> Callable[[], Iterator[Behaviour]]:
    """The tick of `node`, held where a breakpoint asks for it."""

    def tick() -> Iterator[Behaviour]:
        if node.status != Status.RUNNING:
            stop(node, Position.BEFORE)
        yield from type(node).tick(node)
        if node.status != Status.RUNNING:
            stop(node, Position.AFTER)

    return tick

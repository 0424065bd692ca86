"""What stands in for the leaves of a tree that is explored."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any, Protocol

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...skills.core.ports import Key
from ...skills.core.reasons import Failure, Reason
from ...skills.core.skill import Skill
from ..nodes.condition import Condition


class KeyMissing(Exception):  # noqa: N818 a finding about the tree
    """A leaf reads what is not there."""


class Decides(Protocol):
    """Who says how leaves end.

    Attributes:
        board: keys that have been written.
        changed: nodes that were ticked or stopped since it looked last.
    """

    board: set[str]
    changed: set[Behaviour]

    def choose(self, leaf: Stub) -> Any:
        """None or "later" to run on, True for success, or the reason of a failure."""


class Stub(Behaviour):
    """Stands in for a leaf: reads and writes its keys, and ends as the explorer says."""

    def __init__(self, leaf: Behaviour, explorer: Decides) -> None:
        super().__init__(leaf.name)
        self.leaf = leaf
        self.parent = leaf.parent
        self.commands = isinstance(leaf, Skill) and leaf.commands
        asked = leaf.reads().values() if isinstance(leaf, Condition) else self._bound(leaf, "inputs")
        self.reads = {key.name: key.told for key in asked}
        self.writes = [k.name for k in self._bound(leaf, "outputs")]
        self.failure: Failure | None = None
        self._failures: dict[Reason, Failure] = {}  # by what was chosen: most of an exploration meets them again
        self._explorer = explorer
        self._change = partial(explorer.changed.add, self)
        self.tick = self.tick_at_once  # type: ignore[assignment] whoever ticks it takes what it gives

    @staticmethod
    def _bound(leaf: Behaviour, which: str) -> list[Key]:
        if not isinstance(leaf, Skill):
            return []
        return [bound for name, _ in getattr(leaf, which)() if isinstance(bound := leaf.bindings[name], Key)]

    def tick_at_once(self) -> Iterable[Behaviour]:
        """As any leaf of py_trees, without its log and at once: most of an exploration is ticks of stubs."""
        self._change()
        if self.status is not Status.RUNNING:
            self.initialise()
        self.status = self.update()
        return (self,)

    def stop(self, new_status: Status = Status.INVALID) -> None:
        """Take the status; there is nothing to end."""
        self._change()
        self.status = new_status

    def initialise(self) -> None:
        """As a skill does: forget outputs."""
        self.failure = None
        self._explorer.board.difference_update(self.writes)

    def update(self) -> Status:
        """Read, be decided, write."""
        missing = [key for key in self.reads if key not in self._explorer.board]
        if missing:
            raise KeyMissing(f"{self.name} reads {self.reads[missing[0]]}, which has not been written")
        outcome = self._explorer.choose(self)
        if outcome is None or outcome == "later":
            return Status.RUNNING
        if outcome is True:
            self._explorer.board.update(self.writes)
            return Status.SUCCESS
        if outcome not in self._failures:
            self._failures[outcome] = Failure(outcome, "", self.name)
        self.failure = self._failures[outcome]
        return Status.FAILURE

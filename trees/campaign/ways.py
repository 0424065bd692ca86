"""How a run comes to a place: by itself, because something fails on the way, or because an operator stops it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import py_trees
from py_trees.behaviour import Behaviour

from ...skills.core.context import Phase
from ...skills.core.reasons import Reason, SkillFailure
from ...skills.core.skill import Skill
from ..nodes.decorators import RecoverBy
from ..run.runner import Run

Place = tuple[str, str]  # node, phase
FAILED = "made to fail by the campaign"


@dataclass(frozen=True, kw_only=True)
class Way:
    """The way to one place.

    Attributes:
        stop_at: the skill at whose second tick an operator stops the run; None where nobody does.
        fails: skills that fail whenever they start, and why, as if by their own doing.
        goal: node and phase at which they stop failing.
    """

    stop_at: str | None = None
    fails: Mapping[str, Reason] = field(default_factory=dict)
    goal: Place = ("", "")

    def lead(self, run: Run) -> None:
        """Have a run that has not begun go this way."""
        if self.stop_at is not None:
            run.context.observers.append(lambda name, phase: self._stop(run, name, phase))
        if self.fails:
            run.context.observers.append(_Fail(self))

    def stops(self, name: str, phase: str) -> bool:
        """Whether the operator stops the run here."""
        return name == self.stop_at and phase == "step"

    def failing(self, name: str, phase: str) -> Reason | None:
        """Why a skill fails here, as long as the goal is not reached; None where it does not."""
        return self.fails.get(name) if phase == "start" else None

    def _stop(self, run: Run, name: str, phase: str) -> None:
        if self.stops(name, phase):
            run.request_stop(Reason.INTERRUPTED)


class _Fail:
    """Makes skills fail until the run has come to where it should."""

    def __init__(self, way: Way) -> None:
        self._way, self._armed = way, True

    def __call__(self, name: str, phase: Phase) -> None:
        if (name, phase) == self._way.goal:
            self._armed = False
        elif self._armed and (reason := self._way.failing(name, phase)) is not None:
            raise SkillFailure(reason, FAILED)


def triggers_of(root: Behaviour) -> dict[str, dict[str, Reason]]:
    """What must fail, and why, for a skill to run at all: skill -> skills -> reason; empty where nothing need fail.

    A recovery runs when its body fails for one of its reasons, an alternative when all before it have failed.
    """
    return {leaf.name: _needed(leaf) for leaf in root.iterate() if isinstance(leaf, Skill)}


def _needed(leaf: Behaviour) -> dict[str, Reason]:
    made: dict[str, Reason] = {}
    child = leaf
    while child.parent is not None:
        above = child.parent
        if isinstance(above, RecoverBy) and child is not above.body:
            reason = next(reason for reason, tree in above.recoveries.items() if tree is child)
            made |= dict.fromkeys(_deciding(above.body), reason)
        elif isinstance(above, py_trees.composites.Selector):
            for earlier in above.children[: above.children.index(child)]:
                made |= dict.fromkeys(_deciding(earlier), Reason.INTERNAL_ERROR)  # nobody recovers from that
        child = above
    return made


def _deciding(node: Behaviour) -> list[str]:
    """Skills whose failure makes `node` fail, the earliest ones."""
    if isinstance(node, Skill):
        return [node.name]
    if isinstance(node, py_trees.composites.Selector):
        return [name for child in node.children for name in _deciding(child)]
    return next((found for child in node.children if (found := _deciding(child))), [])

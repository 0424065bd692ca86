"""What an operator is told while a tree is ticked: stages and skills as they begin and end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...skills.core.skill import Skill
from ..nodes.decorators import Stage


@dataclass(frozen=True)
class Progress:
    """One change worth telling the operator.

    Attributes:
        time: world clock [s].
        kind: `stage` or `skill`.
        name: of the node.
        status: `running`, `success`, `failure` or `stopped`.
        message: why, or what is going on.
    """

    time: float
    kind: Literal["stage", "skill"]
    name: str
    status: str
    message: str = ""


class Announcer:
    """Tells of each change of a stage or a skill once, a stage before what is below it.

    Args:
        root: the tree.
        now: the world's clock [s].
        tell: called with each change.
    """

    def __init__(self, root: Behaviour, now: Callable[[], float], tell: Callable[[Progress], None]) -> None:
        self._now = now
        self._tell = tell
        shown = (node for node in root.iterate() if isinstance(node, (Skill, Stage)))
        self._above = {node: _stages_above(node) for node in shown}  # stages, outermost first
        self._told: dict[Behaviour, Status] = {}

    def visit(self, node: Behaviour) -> None:
        """Tell of a node that was just ticked, if there is anything new."""
        if node not in self._above:
            return
        assert isinstance(node, (Skill, Stage))
        for stage in self._above[node]:  # py_trees yields children first, an operator reads the stage first
            self._announce(stage, Status.RUNNING)
        self._announce(node, node.status)

    def sweep(self) -> None:
        """Tell what was stopped without being visited; what is reset may be told of again."""
        stopped = [node for node in self._told if node.status is Status.INVALID]
        for node in stopped:
            assert isinstance(node, (Skill, Stage))
            if self._told[node] == Status.RUNNING:
                self._announce(node, Status.INVALID)
            del self._told[node]

    def _announce(self, node: Skill | Stage, status: Status) -> None:
        if self._told.get(node) == status:
            return
        self._told[node] = status
        failure = node.failure if status == Status.FAILURE else None
        if failure is not None and failure.node == node.name:
            failure = replace(failure, node="")  # the line names the node already
        words = {Status.INVALID: "stopped"}.get(status, status.name.lower())
        self._tell(
            Progress(
                self._now(),
                "skill" if isinstance(node, Skill) else "stage",
                node.name,
                words,
                failure.sentence() if failure else node.feedback_message,
            )
        )


def _stages_above(node: Behaviour) -> list[Stage]:
    """The stages that a node belongs to, outermost first."""
    above, parent = [], node.parent
    while parent is not None:
        above += [parent] if isinstance(parent, Stage) else []
        parent = parent.parent
    return above[::-1]

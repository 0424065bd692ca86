"""The trace of a run: one JSON object for each change of a node's status and each command sent.

Its hash covers node paths, statuses, reasons, times and commands, with numbers rounded, and nothing that differs
between two equal runs (no wall time, no versions, no free text).  Equal hashes mean that the same things
happened at the same times.
"""

from __future__ import annotations

import hashlib
import json
import operator
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...sim.world import BaseVelocity, Command, GripperOpening, HandTwist
from ...skills.core.reasons import Failure

DECIMALS = 4  # 0.1 ms, 0.1 mm, 0.1 mrad: far below what matters, far above rounding noise
_STATUS = operator.attrgetter("status")
FREE_TEXT = ("detail",)  # kept in the trace for the reader, left out of the hash
_written = json.JSONEncoder(sort_keys=True, separators=(",", ":")).encode


def paths_of(root: Behaviour) -> dict[Behaviour, str]:
    """Path of every node below `root`, parents first; brothers of one name are numbered."""
    paths = {root: root.name}

    def walk(node: Behaviour) -> None:
        seen: dict[str, int] = {}
        for child in node.children:
            seen[child.name] = seen.get(child.name, 0) + 1
            number = f"#{seen[child.name]}" if seen[child.name] > 1 else ""
            paths[child] = f"{paths[node]}/{child.name}{number}"
            walk(child)

    walk(root)
    return paths


def rounded(value: Any) -> Any:
    """`value` as plain JSON with floats rounded; -0.0 becomes 0.0."""
    if isinstance(value, (float, np.floating)):
        return round(float(value), DECIMALS) + 0.0
    if value is None or isinstance(value, (str, int)):  # most are: an abstract class is slow to say no
        return value
    if isinstance(value, np.ndarray):
        return [rounded(item) for item in value.tolist()]
    if isinstance(value, Mapping):
        return {str(key): rounded(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def canonical(event: Mapping[str, Any]) -> str:
    """The text of an event that the hash covers."""
    return _written({key: value for key, value in event.items() if key not in FREE_TEXT})


def hash_of(events: Iterable[Mapping[str, Any]]) -> str:
    """Hash (hex) of whole traces, as `Trace.digest` gives it."""
    digest = hashlib.sha256()
    for event in events:
        digest.update(canonical(event).encode() + b"\n")
    return digest.hexdigest()


def describe(command: Command) -> dict[str, Any]:
    """A command in a few numbers."""
    if isinstance(command, HandTwist):
        return {"what": "twist", "side": command.side, "twist": command.twist_in_map, "duration": command.duration}
    if isinstance(command, BaseVelocity):
        return {"what": "base", "velocity": command.velocity, "duration": command.duration}
    if isinstance(command, GripperOpening):
        return {"what": "gripper", "side": command.side, "opening": command.opening, "force": command.force_limit}
    return {
        "what": "trajectory",
        "joints": command.joints,
        "duration": float(command.times[-1]),
        "goal": np.asarray(command.positions, float)[-1],
    }


class Trace:
    """Collects events and hands each on as it happens.

    Args:
        root: of the tree.
        now: the world's clock.
        sink: called with each event, for instance a recorder's `event`.
    """

    def __init__(
        self, root: Behaviour, now: Callable[[], float], sink: Callable[[dict[str, Any]], None] | None = None
    ) -> None:
        self.paths = paths_of(root)
        self.events: list[dict[str, Any]] = []
        self._now = now
        self._sink = sink
        self._digest = hashlib.sha256()
        self._last: dict[Behaviour, Status] = {}  # of nodes that are not INVALID

    def add(self, kind: str, **content: Any) -> None:
        """Append one event, stamped with the world's clock."""
        event = rounded({"t": float(self._now()), "kind": kind, **content})
        self.events.append(event)
        self._digest.update(canonical(event).encode() + b"\n")
        if self._sink is not None:
            self._sink(event)

    def visit(self, node: Behaviour) -> None:
        """Note the status of a node if it changed."""
        if self._last.get(node, Status.INVALID) == node.status:
            return
        self._last[node] = node.status
        if node.status == Status.INVALID:
            del self._last[node]
        failure = getattr(node, "failure", None)
        content: dict[str, Any] = {"node": self.paths.get(node, node.name), "status": node.status.name}
        if node.status == Status.FAILURE and isinstance(failure, Failure):
            content |= {"reason": failure.reason.name, "detail": failure.detail}
        self.add("node", **content)

    def sweep(self) -> None:
        """Note every node that changed without being visited (stopped from outside)."""
        if list(map(_STATUS, self._last)) == list(self._last.values()):  # at every tick: compared as a whole
            return
        for node in self.paths:
            if self._last.get(node, Status.INVALID) is not node.status:
                self.visit(node)

    def command(self, command: Command) -> None:
        """Note a command that was really sent."""
        self.add("command", **describe(command))

    def digest(self) -> str:
        """Hash (hex) of everything so far."""
        return self._digest.hexdigest()

"""From a trace to spans of time: when was which skill at work, and how did it end."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError


@dataclass(frozen=True, kw_only=True)
class Span:
    """One stretch of work of one leaf.

    Attributes:
        path: of the node in the tree.
        t_start: world clock [s].
        t_end: world clock [s].
        status: it ended with: `SUCCESS`, `FAILURE`, `INVALID` (stopped from outside) or `RUNNING` (cut short).
        reason: name of the reason of a failure, else empty.
        detail: of that failure, one clause.
        label: the leaf's own name, where it cannot be told from the path: names may hold slashes.
    """

    path: str
    t_start: float
    t_end: float
    status: str
    reason: str = ""
    detail: str = ""
    label: str = ""

    @property
    def name(self) -> str:
        """The leaf's own name, without the number that tells brothers apart."""
        return self.label or self.path.rsplit("/", 1)[-1].split("#")[0]


def read_trace(path: Path) -> list[dict[str, Any]]:
    """Events of a trace file in order; a last line cut short by a kill is left out.

    Raises:
        CaretreeError: the file is missing, or a line is damaged that was written whole.
    """
    try:
        text = path.read_text(encoding="utf-8")
        lines, cut_short = text.splitlines(), not text.endswith("\n")
    except (OSError, UnicodeDecodeError) as error:
        raise CaretreeError(f"{path} cannot be read: {error}") from error
    events = []
    for number, line in enumerate(lines, start=1):
        try:
            event = json.loads(line)
        except (ValueError, RecursionError) as error:
            if number == len(lines) and cut_short:
                break
            raise CaretreeError(f"{path}:{number} is damaged: {error}") from error
        if not isinstance(event, dict):
            raise CaretreeError(f"{path}:{number} holds a {type(event).__name__}, but an object is asked for")
        events.append(event)
    return events


def spans_of(events: Iterable[Mapping[str, Any]]) -> list[Span]:
    """Spans of the leaves that took time, and those that failed at once for a reason, in order of their start."""
    events = [event for event in events if isinstance(event.get("t"), (int, float))]
    changes = [event for event in events if event.get("kind") == "node" and isinstance(event.get("node"), str)]
    names = _names({event["node"] for event in changes})
    begun: dict[str, float] = {}
    spans = []
    for event in changes:
        path, status = event["node"], event.get("status")
        if path not in names:
            continue
        if status == "RUNNING":
            begun.setdefault(path, event["t"])
        elif path in begun or (status == "FAILURE" and event.get("reason")):
            spans.append(
                Span(
                    path=path,
                    t_start=begun.pop(path, event["t"]),
                    t_end=event["t"],
                    status=str(status),
                    reason=str(event.get("reason") or ""),
                    detail=str(event.get("detail") or ""),
                    label=names[path],
                )
            )
    last = max((event["t"] for event in events), default=0.0)
    spans += [
        Span(path=path, t_start=start, t_end=last, status="RUNNING", label=names[path]) for path, start in begun.items()
    ]
    return sorted(spans, key=lambda span: span.t_start)


def _names(paths: set[str]) -> dict[str, str]:
    """Path of each leaf -> its own name: what follows the longest path that is a node above it."""
    above: dict[str, str] = {}
    for path in paths:
        at = path.rfind("/")
        while at >= 0 and path[:at] not in paths:
            at = path.rfind("/", 0, at)
        above[path] = path[:at] if at >= 0 else ""
    parents = set(above.values())
    return {
        path: path[len(parent) + 1 if parent else path.rfind("/") + 1 :].split("#")[0]
        for path, parent in above.items()
        if path not in parents
    }

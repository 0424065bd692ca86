"""A tree as rows of text with statuses, for the report, the live view and the replay."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from py_trees.behaviour import Behaviour

from ...sim.record.record import TREE_FILE
from ...sim.record.spool import disk_error
from ..run.trace import paths_of

UNTOUCHED = "·"
SIGNS = {
    "SUCCESS": ("✓", "#2f7d40"),
    "FAILURE": ("✗", "#b23a31"),
    "RUNNING": ("▶", "#a8761a"),
    "INVALID": ("-", "#9aa3ad"),
}


@dataclass(frozen=True)
class Row:
    """One node.

    Attributes:
        path: as the trace has it.
        name: its own.
        kind: name of its class; empty where it is not known.
        depth: how many nodes are above it.
    """

    path: str
    name: str
    kind: str
    depth: int


@dataclass(frozen=True)
class State:
    """What a node came to.

    Attributes:
        status: `RUNNING`, `SUCCESS`, `FAILURE` or `INVALID`, which here means that it was stopped.
        words: why, or what is going on.
    """

    status: str
    words: str = ""


def outline_of(root: Behaviour) -> list[Row]:
    """Rows of a tree, parents before children, children in order."""
    paths, rows = paths_of(root), []

    def walk(node: Behaviour, depth: int) -> None:
        rows.append(Row(paths[node], node.name, type(node).__name__, depth))
        for child in node.children:
            walk(child, depth + 1)

    walk(root, 0)
    return rows


def outline_from(events: Iterable[Mapping[str, Any]]) -> list[Row]:
    """Rows of those nodes that a trace tells of, where a record holds no tree."""
    paths = dict.fromkeys(event["node"] for event in events if isinstance(event.get("node"), str))
    rows: list[Row] = []
    above: list[str] = []
    for path in sorted(paths):
        while above and not path.startswith(f"{above[-1]}/"):
            above.pop()
        name = path[len(above[-1]) + 1 :] if above else path
        rows.append(Row(path, name.split("#")[0], "", len(above)))
        above.append(path)
    return rows


def write_outline(directory: Path, rows: Sequence[Row]) -> None:
    """Keep the tree with the record.

    Raises:
        RecordError: it cannot be written.
    """
    path = directory / TREE_FILE
    try:
        path.write_text(json.dumps([asdict(row) for row in rows]) + "\n", encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error


def read_outline(directory: Path, events: Iterable[Mapping[str, Any]]) -> list[Row]:
    """The tree of a record; what `events` tell of it where it was not kept, or is damaged."""
    try:
        rows = json.loads((directory / TREE_FILE).read_text(encoding="utf-8"))
        return [Row(str(row["path"]), str(row["name"]), str(row["kind"]), int(row["depth"])) for row in rows]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return outline_from(events)


def states_at(events: Iterable[Mapping[str, Any]], time: float = float("inf")) -> dict[str, State]:
    """What each node that was ticked had come to at `time` [s]: the last that it came to by itself, if anything."""
    states: dict[str, State] = {}
    for event in events:
        path, status = event.get("node"), event.get("status")
        if event.get("kind") != "node" or not isinstance(path, str) or status not in SIGNS:
            continue
        if isinstance(event.get("t"), (int, float)) and event["t"] > time:
            break
        if status == "INVALID" and path in states and states[path].status != "RUNNING":
            continue  # it had ended, and was reset
        words = " ".join(str(event[key]) for key in ("reason", "detail") if event.get(key))
        states[path] = State(str(status), words)
    return states


def outline_html(rows: Sequence[Row], states: Mapping[str, State], *, folded: bool) -> str:
    """The tree as HTML; `folded` leaves out what lies below nodes that were not ticked, or no longer run.

    Rows that are left out are those of which nobody asks at this moment: a live view has room for a few.
    """
    lines, open_to = [], 0
    for row in rows:
        if folded and row.depth > open_to:
            continue
        state = states.get(row.path)
        status = state.status if state else ""
        open_to = row.depth + 1 if status in ("RUNNING", "FAILURE") else row.depth
        sign, colour = SIGNS.get(status, (UNTOUCHED, "#c4cad0"))
        weight = "600" if status == "RUNNING" else "400"
        words = f' <span style="color:#66727d">{html.escape(state.words)}</span>' if state and state.words else ""
        ink = "#1d252c" if state else "#9aa3ad"
        lines.append(
            f'<div title="{html.escape(row.kind)}" style="padding-left:{0.9 * row.depth:.1f}em;font-weight:{weight};'
            f'color:{ink}"><span style="color:{colour}">{sign}</span> {html.escape(row.name)}{words}</div>'
        )
    return f'<div style="font:13px/1.45 system-ui,sans-serif">{"".join(lines)}</div>'

"""The fault campaign as a page: node by fault, coloured by how it ended, with the time until the person was safe."""

from __future__ import annotations

import html
from collections.abc import Sequence
from pathlib import Path

from ...sim.record.spool import disk_error
from .fault_row import Row

PAGE = "inject.html"
COLOURS = {
    "success": "#cfe8cf",
    "safe_stop": "#fff0b8",
    "failure": "#f2b8a8",
    "unsafe": "#d03030",
    "not_reached": "#eee",
}
WORDS = {
    "success": "the task succeeds all the same",
    "safe_stop": "safe stop",
    "failure": "failure without a safe stop",
    "unsafe": "unsafe afterwards",
    "not_reached": "not reached: nothing is said of it",
}
HEAD = """<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>{title}</title><style>
body {{ font: 14px sans-serif; margin: 2em }} table {{ border-collapse: collapse }}
td, th {{ border: 1px solid #fff; padding: 2px 8px; text-align: left }} td.cell {{ text-align: right }}
thead th {{ position: sticky; top: 0; background: #fff }}</style>"""


def write_heat_map(directory: Path, title: str, rows: Sequence[Row]) -> Path:
    """Write inject.html.

    Raises:
        RecordError: it cannot be written.
    """
    path = directory / PAGE
    try:
        path.write_text(page(title, rows), encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise disk_error(error, f"writing {path}") from error
    return path


def page(title: str, rows: Sequence[Row]) -> str:
    """The page: one line for each node and phase, one column for each fault; a cell has the seconds to safety."""
    faults = list(dict.fromkeys(row.fault for row in rows))
    cells = {row.key: row for row in rows}
    name = html.escape(title)
    lines = [HEAD.format(title=name), f"<h1>{name}</h1>", f"<p>{_counts(rows)}</p>"]
    lines.append("<p>Numbers: seconds of the world's clock from the fault to the end of the run, standing still.</p>")
    lines.append("<table><thead><tr><th>node<th>phase" + "".join(f"<th>{html.escape(f)}" for f in faults) + "</thead>")
    for node, phase in dict.fromkeys((row.node, row.phase) for row in rows):
        found = "".join(_cell(cells.get((node, phase, fault))) for fault in faults)
        lines.append(f"<tr><th>{html.escape(node)}<td>{html.escape(phase)}{found}")
    return "\n".join([*lines, "</table>", ""])


def _cell(row: Row | None) -> str:
    if row is None:
        return "<td>"
    told = html.escape(f"{row.outcome.replace('_', ' ')}: {row.unsafe or row.reason}", quote=True)
    seconds = "" if row.time_to_safe is None else f"{row.time_to_safe:.1f}"
    return f'<td class="cell" style="background:{COLOURS[_kind(row)]}" title="{told}">{seconds}'


def _kind(row: Row) -> str:
    return "unsafe" if row.unsafe else row.outcome


def _counts(rows: Sequence[Row]) -> str:
    kinds = [_kind(row) for row in rows]
    return " ".join(
        f'<span style="background:{COLOURS[kind]}">&nbsp;{kinds.count(kind)}&nbsp;</span> {word}'
        for kind, word in WORDS.items()
    )

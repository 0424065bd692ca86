"""How one injected fault ended: a row of the fault campaign, and the table of all of them."""

from __future__ import annotations

import collections
from dataclasses import asdict, dataclass
from typing import Any

FaultKey = tuple[str, str, str]  # node, phase, fault
SIGNS = {"success": "ok", "safe_stop": "stop", "failure": "fail", "not_reached": "-"}


@dataclass(frozen=True, kw_only=True)
class Row:
    """How one injected fault ended.

    Attributes:
        node, phase, fault: what was injected where.
        outcome: of the run, or `not_reached`.
        reason: one sentence; of one that was not reached, where runs are not all alike, how its run ended.
        unsafe: what was still wrong afterwards; empty when nothing was.
        time_to_safe: world time from the first fault to the end of the run, which stands still [s]; None where the
            fault did not begin.
    """

    node: str
    phase: str
    fault: str
    outcome: str
    reason: str = ""
    unsafe: str = ""
    time_to_safe: float | None = None

    @property
    def key(self) -> FaultKey:
        """What identifies the row."""
        return self.node, self.phase, self.fault

    @property
    def survived(self) -> bool:
        """Whether it ended in recovery or in the safe stop, and safely."""
        return not self.unsafe and self.outcome in ("success", "safe_stop", "not_reached")

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def not_reached(key: FaultKey) -> Row:
    """The row of a place that no run comes to."""
    node, phase, fault = key
    return Row(node=node, phase=phase, fault=fault, outcome="not_reached")


def table(rows: list[Row]) -> str:
    """One line for each node and phase, one column for each fault, and the count of outcomes."""
    faults = list(dict.fromkeys(row.fault for row in rows))
    cells = {row.key: "UNSAFE" if row.unsafe else SIGNS[row.outcome] for row in rows}
    places = list(dict.fromkeys((row.node, row.phase) for row in rows))
    head = ["node", "phase", *faults]
    lines = [head, *([*place, *(cells.get((*place, fault), "") for fault in faults)] for place in places)]
    widths = [max(len(line[n]) for line in lines) for n in range(len(head))]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    counts = collections.Counter(row.outcome for row in rows)
    bad = [row for row in rows if not row.survived]
    text += ["", ", ".join(f"{counts[outcome]} {outcome.replace('_', ' ')}" for outcome in SIGNS if counts[outcome])]
    text += [
        f"not survived: {row.fault}@{row.node}:{row.phase}: {row.outcome}, {row.unsafe or row.reason}" for row in bad
    ]
    return "\n".join(text)

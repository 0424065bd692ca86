"""The table of an evaluation: what was asked for, what was reached, by whom, on how many."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from .evaluate import SETS
from .scores import Tally
from .states import KINDS

Read = Callable[[Tally], tuple[float, int]]
Line = tuple[str, str, str, Read]  # what, unit, what is asked for, how it is read


def _lines(tallies: Mapping[str, Tally]) -> Iterator[Line]:
    for group in SETS:
        goal = "0.92" if group == "held out" else "0.95" if group in ("plain", "printed") else ""
        for kind in KINDS:
            yield f"gown IoU, {group}, {kind}", "", goal, lambda t, n=f"gown, {group}, {kind}": t.iou(n)
    for group in SETS:
        yield f"binding IoU, {group}", "", "", lambda t, n=f"binding, {group}": t.iou(n)
        yield f"skin IoU, {group}", "", "", lambda t, n=f"skin, {group}": t.iou(n)
    for group in SETS:
        for kind, goal in (("held", "0.99"), ("hung", "0.95")):
            yield f"side, {group}, {kind}", "", goal, lambda t, n=f"side, {group}, {kind}": t.rate(n)
    for group in SETS:
        for kind, goal in (("hung", "0.90"), ("held", "")):
            for camera in ("head", "hand"):
                name = f"corner, {group}, {kind}, {camera}"
                yield f"{name}: shown, within 5 cm", "", goal, lambda t, n=name: t.rate(n)
            told = f"corner told, {group}, {kind}"
            yield f"{told}: of those told, within 5 cm", "", "", lambda t, n=told: t.rate(n)
        name = f"strap, {group}, laid, hand"
        yield f"{name}: shown, within 4 cm", "", "0.90", lambda t, n=name: t.rate(n)
    for group in SETS:
        for kind in KINDS:
            name = f"sheet, {group}, {kind}"
            yield f"{name}: median of pictures' medians", "m", "0.04", lambda t, n=name: t.median(n)
    for group in _persons(tallies):
        for how, goal in (("shown", "0.03"), ("covered", "0.05")):
            name = f"joint, {group}, {how}"
            yield f"{name}: median", "m", goal, lambda t, n=name: t.median(n)
        yield f"joint found, {group}", "", "", lambda t, n=f"joint found, {group}": t.rate(n)
    for what in ("surface", "key point"):
        yield f"calibration error, {what}", "", "0.05", lambda t, n=what: t.calibration_error(n)
    yield "corners told where there is no gown", "", "0", lambda t: t.rate("no gown, corner")
    yield "processor time of all seeing, a frame", "ms", "30", lambda t: t.median("ms surfaces")


def _persons(tallies: Mapping[str, Tally]) -> list[str]:
    """Groups of arms, in the order in which they came."""
    names = (name for tally in tallies.values() for name in tally.values if name.startswith("joint, "))
    return list(dict.fromkeys(name.split(", ")[1] for name in names))


def rows(tallies: Mapping[str, Tally]) -> list[dict]:
    """One row for each number: `what`, `unit`, `goal`, and by name of who sees `value` and `n`."""
    found = []
    for what, unit, goal, read in _lines(tallies):
        seen = {name: read(tally) for name, tally in tallies.items()}
        if any(n for _, n in seen.values()):
            row: dict = {"what": what, "unit": unit, "goal": goal}
            found.append(row | {name: [None if math.isnan(v) else v, n] for name, (v, n) in seen.items()})
    return found


def table(found: list[dict], about: str) -> str:
    """The rows as Markdown."""
    who = [key for key in found[0] if key not in ("what", "unit", "goal")] if found else []
    lines = [about, "", "| what | asked for | " + " | ".join(who) + " | n |", "|---" * (3 + len(who)) + "|"]
    for row in found:
        cells = [_shown(row[name][0], row["unit"]) for name in who]
        count = max(row[name][1] for name in who)
        asked = f"{row['goal']} {row['unit']}".strip() if row["goal"] else ""
        lines.append(f"| {row['what']} | {asked} | {' | '.join(cells)} | {count} |")
    return "\n".join(lines)


def _shown(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    if math.isinf(value):
        return "not found"
    return f"{value:.1f} {unit}" if unit == "ms" else f"{value:.3f} {unit}".strip()

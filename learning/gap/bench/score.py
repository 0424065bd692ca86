"""Score verdicts against the truth, with exact 95 % intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.stats import beta

Row = dict[str, Any]
APART = 4.0  # [standard deviations]; an observer who knows the noise is then right in 98 of 100 cases


def interval(hits: int, n: int) -> tuple[float, float]:
    """Clopper-Pearson 95 % interval of a proportion."""
    low = float(beta.ppf(0.025, hits, n - hits + 1)) if hits else 0.0
    high = float(beta.ppf(0.975, hits + 1, n - hits)) if hits < n else 1.0
    return low, high


def judge_case(truth: Row, verdict: Row) -> Row:
    """One case: what was hidden, what was said, and which of the benchmark's questions it answers right."""
    hidden = {(e["name"], e["target"]) for e in truth["effects"] if truth["kind"] in ("single", "two")}
    said = {(e["name"], e["target"]) for e in verdict["effects"]}
    sizes = [e["size"] for e in truth["effects"]]
    return {
        "system": truth["system"],
        "seed": truth["seed"],
        "kind": truth["kind"],
        "verdict": verdict["verdict"],
        "hidden": sorted(map(list, hidden)) if hidden else [[e["name"], e["target"]] for e in truth["effects"]],
        "said": sorted(map(list, said)),
        "size": min(sizes) if sizes else 0.0,
        "exact": verdict["verdict"] != "unknown" and said == hidden,
        "up_to_equivalents": verdict["verdict"] != "unknown" and _equivalent(hidden, verdict["effects"]),
        "together": verdict["verdict"] != "unknown" and (said == hidden or _listed(hidden, verdict)),
        "told": verdict["verdict"] != "unknown"
        and (_equivalent(hidden, verdict["effects"]) or _listed(hidden, verdict)),
        "rivals": len(verdict.get("rivals", ())),
        "joint": hidden <= said or {t for _, t in hidden} == {t for _, t in said},
        "false_alarm": truth["kind"] in ("none", "recalibration") and bool(said or verdict["verdict"] == "unknown"),
        "overlap": _overlap(truth, verdict),
        "closed": verdict["gap"].get("closed"),
        "seconds": verdict.get("seconds", 0.0),
        "apart": truth.get("apart"),
        "intervals": [] if verdict["verdict"] == "unknown" else _intervals(truth, verdict),
        "changes_told": _changes_told(truth.get("changes", []), verdict.get("changes", [])),
    }


SOON, NEAR = 2.0, 0.2  # [s], [kg]; how well a payload's change has to be told


def _changes_told(hidden: Sequence[Sequence[Any]], said: Sequence[Row]) -> bool:
    """Whether every change of a payload is told, with its time and both masses, and no other is."""
    return len(hidden) == len(said) and all(
        any(
            s["episode"] == episode
            and abs(s["t"] - t) <= SOON
            and abs(s["before"] - before) <= NEAR
            and abs(s["after"] - after) <= NEAR
            for s in said
        )
        for episode, t, before, after in hidden
    )


def _intervals(truth: Row, verdict: Row) -> list[Row]:
    """Every stated number of an effect that is really there: its name, the truth, what was said of it.

    Of several payloads, one after the other, the nearest is meant.
    """
    real: dict[tuple[str, str, str], list[float]] = {}
    for e in truth["effects"]:
        for name, value in e.get("values", {}).items():
            real.setdefault((e["name"], e["target"], name), []).append(value)
    said = [*verdict["effects"], *verdict.get("recalibration", ())]
    return [
        {
            "effect": f["name"],
            "parameter": p["name"],
            "truth": min(real[f["name"], f["target"], p["name"]], key=lambda x: abs(x - p["value"])),
            **{k: p[k] for k in ("value", "low", "high")},
            "doubt": p.get("doubt", ""),
        }
        for f in said
        for p in f["parameters"]
        if (f["name"], f["target"], p["name"]) in real
    ]


def _listed(hidden: set[tuple[str, str]], verdict: Row) -> bool:
    """Whether the hidden set is among those that are said to fit as well."""
    return any({tuple(x) for x in r["effects"]} == hidden for r in verdict.get("rivals", ()))


def _equivalent(hidden: set[tuple[str, str]], effects: list[Row]) -> bool:
    """Whether swapping effects for their reported equivalents gives the hidden set."""
    options = [
        [
            frozenset({(e["name"], e["target"])}),
            *(
                frozenset(
                    (part.split(" of ")[0], part.split(" of ")[1] if " of " in part else e["target"])
                    for part in q.split(" + ")
                )
                for q in e.get("equivalent", [])
            ),
        ]
        for e in effects
    ]
    reached = {frozenset()}
    for choices in options[:6]:
        reached = {r | c for r in reached for c in choices}
    return frozenset(hidden) in reached


def _overlap(truth: Row, verdict: Row) -> float | None:
    """Intersection over union of hidden intervals and those found on the hidden target; None where none is hidden."""
    if not truth["intervals"]:
        return None
    target = next((e["target"] for e in truth["effects"] if e["name"] in ("contact", "snag")), None)
    total = both = 0.0
    for episode in {i[0] for i in truth["intervals"]}:
        grid = np.linspace(0.0, 40.0, 20001)
        real, found = np.zeros(len(grid), bool), np.zeros(len(grid), bool)
        for e, a, b in truth["intervals"]:
            if e == episode:
                real |= (grid >= a) & (grid <= b)
        for w in verdict["where"]:
            if w["episode"] == episode and w["target"] == target and w["effect"] in ("contact", "snag"):
                found |= (grid >= w["t0"]) & (grid <= w["t1"])
        both += (real & found).sum()
        total += (real | found).sum()
    return float(both / total) if total else 0.0


def _apart(row: Row) -> float:
    """Distance of the truth from its nearest rival [standard deviations], -1 where it was not worked out."""
    return -1.0 if row.get("apart") is None else float(row["apart"])


Answer = tuple[str, str, int, int, float, float, float]  # question, system, right, asked, rate, low, high


def table(rows: list[Row]) -> list[Answer]:
    """(question, system, right, asked, rate, low, high) for every system."""
    out: list[Answer] = []
    for system in sorted({r["system"] for r in rows}):
        mine = [r for r in rows if r["system"] == system]
        for question, asked, right in (*_effect_questions(mine), *_verdict_questions(mine), *_interval_questions(mine)):
            if asked:
                hits = sum(right(r) for r in asked)
                out.append((question, system, hits, len(asked), hits / len(asked), *interval(hits, len(asked))))
        out += _closed_gap(system, mine)
        seconds = np.array([r["seconds"] for r in mine])
        n, middle = len(mine), float(np.median(seconds))
        out.append(
            ("seconds per set, median and range", system, n, n, middle, float(seconds.min()), float(seconds.max()))
        )
    return out


Question = tuple[str, list[Row], Callable[[Row], bool]]  # its text, the rows it is asked of, whether one is right


def _large_single(rows: list[Row]) -> list[Row]:
    return [r for r in rows if r["kind"] == "single" and r["size"] >= 2.0]


def _distinct(rows: list[Row]) -> list[Row]:
    """Rows whose truth is far from its nearest rival."""
    return [r for r in rows if _apart(r) >= APART]


def _effect_questions(rows: list[Row]) -> list[Question]:
    """Whether the named set of effects is right."""
    big = _large_single(rows)
    small = [r for r in rows if r["kind"] == "single" and r["size"] < 2.0]
    two = [r for r in rows if r["kind"] == "two"]
    none = [r for r in rows if r["kind"] in ("none", "recalibration")]
    wrong = [r for r in rows if r["kind"] in ("single", "two") and r["verdict"] == "effects" and not r["exact"]]
    asked = (
        ("single effect, size >= 2, exact set", big, "exact"),
        ("single effect, size >= 2, up to stated equivalents", big, "up_to_equivalents"),
        ("single effect, size < 2, exact set", small, "exact"),
        ("two effects, exact set", two, "exact"),
        ("two effects, up to stated equivalents", two, "up_to_equivalents"),
        ("two effects, exact or listed among the sets that fit as well", two, "together"),
        ("single effect, exact or told as equal", [r for r in rows if r["kind"] == "single"], "told"),
        ("two effects, exact or told as equal", two, "told"),
        ("wrong set named, the truth among its equals", wrong, "told"),
        ("two effects, both >= 2, exact set", [r for r in two if r["size"] >= 2], "exact"),
        (f"two effects, apart >= {APART:g} sd, exact set", _distinct(two), "exact"),
        (f"two effects, apart < {APART:g} sd, exact set", [r for r in two if 0 <= _apart(r) < APART], "exact"),
        ("false alarm where nothing is missing", none, "false_alarm"),
        (f"single, size >= 2, apart >= {APART:g} sd, exact set", _distinct(big), "exact"),
        ("right joint, single effect, size >= 2", big, "joint"),
    )
    return [(text, where, lambda r, key=key: bool(r[key])) for text, where, key in asked]


def _verdict_questions(rows: list[Row]) -> list[Question]:
    """Whether the verdict's one word is right."""
    recalibrated = [r for r in rows if r["kind"] == "recalibration"]
    outside = [r for r in rows if r["kind"] == "outside"]
    asked = (
        ("recalibration named as such", recalibrated, "recalibration"),
        ("unknown on effects outside the registry", outside, "unknown"),
        (f"unknown, outside the registry, apart >= {APART:g} sd", _distinct(outside), "unknown"),
    )
    changed = [r for r in rows if r["kind"] == "change"]
    kept = [r for r in rows if r["kind"] == "constant"]
    return [
        *((text, where, lambda r, good=good: r["verdict"] == good) for text, where, good in asked),
        (f"payload changes, all told within {SOON:g} s and {NEAR:g} kg", changed, lambda r: r["changes_told"]),
        ("payload changes, verdict not unknown", changed, lambda r: r["verdict"] != "unknown"),
        ("payload stays, a change said all the same", kept, lambda r: not r["changes_told"]),
    ]


def _interval_questions(rows: list[Row]) -> list[Question]:
    """Whether a local effect is found where it acts, and how often a stated interval holds the truth."""
    local = [r for r in rows if r["overlap"] is not None and r["size"] >= 2.0]
    known = [i for r in rows for i in r["intervals"]]
    sure = [i for i in known if not i["doubt"]]
    named = [
        i
        for r in rows
        if r["exact"] or r["kind"] in ("recalibration", "change", "constant")
        for i in r["intervals"]
        if not i["doubt"]
    ]
    return [
        ("interval overlap at least 0.7, size >= 2", local, lambda r: r["overlap"] >= 0.7),
        ("95 % interval holds the truth", sure, holds),
        ("95 % interval holds the truth, exact set", named, holds),
        ("number whose interval is said not to hold", known, lambda i: bool(i["doubt"])),
    ]


def holds(stated: Row) -> bool:
    """Whether a stated interval holds the truth; an end that was not finite is none."""
    above = stated["low"] is None or stated["low"] <= stated["truth"]
    return above and (stated["high"] is None or stated["truth"] <= stated["high"])


def _closed_gap(system: str, rows: list[Row]) -> list[Answer]:
    """Median part of the held-out gap that is closed, with its bootstrap interval."""
    closed = np.array([r["closed"] for r in _large_single(rows) if r["closed"] is not None])
    n = len(closed)
    if not n:
        return []
    draws = np.median(np.random.default_rng(0).choice(closed, (500, n)), axis=1)
    low, high = (float(x) for x in np.quantile(draws, [0.025, 0.975]))
    return [("median part of the gap closed, size >= 2", system, n, n, float(np.median(closed)), low, high)]


def side_by_side(rounds: Sequence[list[Row]]) -> list[str]:
    """The table as lines, one column per round of the same cases."""
    answers = [{(q, s): rest for q, s, *rest in table(rows)} for rows in rounds]
    titles = ["right        rate (95 % interval)"]
    if len(rounds) > 1:
        titles = ["first round", "with the recordings asked for"]
    out = [f"{'question':62s} {'system':6s} " + "  ".join(f"{t:>35s}" for t in titles)]
    for key in dict.fromkeys(k for a in answers for k in a):
        cells = [a.get(key) for a in answers]
        shown = [f"{c[0]:4d}/{c[1]:4d}  {c[2]:.3f} ({c[3]:.3f} to {c[4]:.3f})" if c else "-" for c in cells]
        out.append(f"{key[0]:62s} {key[1]:6s} " + "  ".join(f"{x:>35s}" for x in shown))
    return out

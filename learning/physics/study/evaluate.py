"""The table: median M_eg of every method on every test, per parameter too, and whether the intervals hold."""

from __future__ import annotations

import json
import os
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from ..clips.parameters import NAMES, SHOWN, to_values
from ..networks.training import machine
from .metrics import coverage, garment_error, median_interval, relative_errors
from .registry import TITLES
from .study import Study, predictions


def rows_of(study: Study) -> list[dict[str, Any]]:
    """One row for each test, method and seed, from the predictions kept."""
    rows = []
    simulated = {
        test: len(kept["true"])
        for test, method, _, kept in predictions(study.folder)
        if method == "gp_inversion_simulated"
    }
    for test, method, seed, kept in predictions(study.folder):
        true, estimated = to_values(kept["true"]), to_values(kept["unit"])
        median, low, high = median_interval(garment_error(true, estimated, list(SHOWN)))
        row: dict[str, Any] = {
            "test": test, "method": method, "seed": seed, "clips": len(true),
            "median": median, "low": low, "high": high,
            "median_all": float(np.median(garment_error(true, estimated))),
            "parameters": dict(zip(NAMES, np.median(relative_errors(true, estimated), axis=0).tolist(), strict=True)),
        }  # fmt: skip
        if "lower" in kept:
            inside = coverage(kept["true"], kept["lower"], kept["upper"])
            row["coverage"] = dict(zip(NAMES, inside.tolist(), strict=True))
            row["coverage_shown"] = float(inside[list(SHOWN)].mean())
            width = np.median(to_values(kept["upper"]) / to_values(kept["lower"]), axis=0)
            row["interval_ratio"] = dict(zip(NAMES, width.tolist(), strict=True))
        if test in simulated:  # the same clips as those that were simulated again, for a fair comparison
            row["first"] = simulated[test]
            row["median_first"] = float(np.median(garment_error(true, estimated, list(SHOWN))[: simulated[test]]))
        rows.append(row)
    return rows


def write_results(study: Study) -> Path:
    """Write results.json into the study's folder; returns its path."""
    data = study.data
    content = {
        "data": {"kind": data.kind, "hash": data.examples.hash, "clips": len(data.examples),
                 "classes": len(set(data.examples.class_id.tolist())),
                 "train": int((data.split == "train").sum()), "test": int((data.split == "test").sum())},
        "steps": study.plan.steps, "backbone": study.plan.backbone, "seeds": list(study.seeds),
        "simulated": study.simulate, "calibrated_on": study.calibrate, "machine": machine(), "rows": rows_of(study),
    }  # fmt: skip
    path = study.folder / "results.json"
    part = path.with_suffix(".part")
    part.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    os.replace(part, path)
    return path


def table(results: dict[str, Any]) -> str:
    """Markdown: one table for each test, medians in per cent, over seeds where there are several."""
    grouped: dict[str, dict[str, list[dict[str, Any]]]] = defaultdict(lambda: defaultdict(list))
    for row in results["rows"]:
        grouped[row["test"]][row["method"]].append(row)
    out = [f"Networks: backbone `{results['backbone']}`, {results['steps']} steps a phase.", ""]
    for test, methods in grouped.items():
        first = sorted({f"first {row['first']} clips" for rows in methods.values() for row in rows if "first" in row})
        head = ["method", "M_eg, shown parameters", *first, "all six", *NAMES, "90 % intervals hold"]
        out += [f"### {test}", "", f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
        for name, title in TITLES.items():
            if name in methods:
                out.append(_line(title, methods[name]))
        out.append("")
    return "\n".join(out)


def _line(title: str, rows: list[dict[str, Any]]) -> str:
    medians = [row["median"] for row in rows]
    text = f"{_percent(float(np.mean(medians)))}"
    text += (
        f" ({', '.join(_percent(m) for m in medians)})"
        if len(rows) > 1
        else f" ({_percent(rows[0]['low'])} to {_percent(rows[0]['high'])})"
    )
    each = [_percent(float(np.mean([row["parameters"][name] for row in rows]))) for name in NAMES]
    held = f"{100 * rows[0]['coverage_shown']:.0f} %" if "coverage_shown" in rows[0] else ""
    means = [_percent(float(np.mean([row[k] for row in rows]))) for k in ("median_first", "median_all") if k in rows[0]]
    return f"| {' | '.join([title, text, *means, *each, held])} |"


def _percent(share: float) -> str:
    return f"{100 * share:.3g} %"

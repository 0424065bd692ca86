"""What simpler ways to name effects reach on the same sets: one-shot least squares, STLSQ and the all-terms fit.

All three get the same logs, the same noise estimate and the same bank as the workflow, one shape per effect.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..joints.block import Block, bank
from ..joints.gram import assemble
from ..joints.log import read_logs
from ..joints.search import bounded_solve
from ..joints.study import columns_of, rigid_model
from ..joints.workflow import one_shape_each
from ..measurement import load_set
from .score import interval

Named = set[tuple[str, str]]
METHODS = ("one-shot least squares", "STLSQ", "all terms")
QUESTIONS = {"single": "exact, single >= 2", "two": "exact, two effects", "none": "false alarm"}
KEEP = 0.2  # an effect is named where its load exceeds this part of the residual left, root mean square


def compare(cases: list[tuple[str, int]], out: Path, say: Callable[[str], None]) -> list[str]:
    """Exact-set rate of each method on single effects of size 2 and more and on pairs, and its false alarms."""
    wanted = [(s, k) for s, k in cases if s in ("arm", "axis")]
    tally = {(m, q): [0, 0] for m in METHODS for q in QUESTIONS}
    for count, (system, seed) in enumerate(wanted):
        name = f"{system}_{seed:05d}"
        truth = json.loads((out / "truth" / f"{name}.json").read_text())
        kind = truth["kind"]
        if kind not in QUESTIONS or (kind == "single" and truth["effects"][0]["size"] < 2.0):
            continue
        hidden = {(e["name"], e["target"]) for e in truth["effects"]}
        for method, said in zip(METHODS, _solve(out / "sets" / name), strict=True):
            tally[method, kind][0] += bool(said) if kind == "none" else said == hidden
            tally[method, kind][1] += 1
        if count % 10 == 9:
            say(f"ablations {count + 1}/{len(wanted)}")
    lines = []
    for method in METHODS:
        for kind, label in QUESTIONS.items():
            hits, n = tally[method, kind]
            if n:
                low, high = interval(hits, n)
                lines.append(
                    f"{method + ': ' + label:52s} joints {hits:4d}/{n:4d}  {hits / n:.3f} ({low:.3f} to {high:.3f})"
                )
    return lines


def _solve(folder: Path) -> tuple[Named, Named, Named]:
    measured = load_set(folder)
    names = columns_of(measured)
    model = rigid_model(measured, len(names.q))
    logs = [log for log in read_logs(list(measured.episodes), names, model) if log.role != "heldout"]
    blocks = one_shape_each([b for b in bank(model, logs, measured.system)])
    gram = assemble(blocks, logs)
    G, b = gram.G.sum(axis=0), gram.b.sum(axis=0)
    yy, rows = gram.yy.sum(axis=0), gram.rows.sum(axis=0)
    weight = rows / np.maximum(yy, 1e-30)
    A, r = np.einsum("c,cij->ij", weight, G), weight @ b
    size = np.sqrt(np.diag(A)) + 1e-12
    whole = bounded_solve(A, r, [p for block in blocks for p in block.parameters])
    left = float(weight @ yy - 2 * whole @ r + whole @ A @ whole)
    every = np.array([abs(t) * s for t, s in zip(whole, size, strict=True)])
    noise = np.sqrt(max(left, 1e-12))
    all_terms = {blocks[i].key for i, s in enumerate(gram.spans) if np.any(every[s] > KEEP * noise)}
    alone = set()
    for i, s in enumerate(gram.spans):  # each effect on its own
        theta = np.linalg.lstsq(A[s, s], r[s], rcond=None)[0]
        if theta @ r[s] > KEEP * float(weight @ yy):
            alone.add(blocks[i].key)
    return alone, _stlsq(A, r, size, blocks, gram.spans, KEEP * noise), all_terms


def _stlsq(
    A: np.ndarray, r: np.ndarray, size: np.ndarray, blocks: list[Block], spans: list[slice], level: float
) -> Named:
    """Sequentially thresholded least squares on columns scaled to unit size."""
    active = np.ones(len(r), dtype=bool)
    theta = np.zeros(len(r))
    for _ in range(20):
        k = np.flatnonzero(active)
        if not len(k):
            break
        theta[:] = 0.0
        theta[k] = np.linalg.lstsq(A[np.ix_(k, k)] + 1e-9 * np.diag(size[k] ** 2), r[k], rcond=None)[0]
        keep = np.abs(theta * size) > level
        if np.array_equal(keep, active):
            break
        active = keep & active
    return {blocks[i].key for i, s in enumerate(spans) if np.any(active[s] & (theta[s] != 0))}

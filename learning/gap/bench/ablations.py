"""What simpler ways to name effects reach on the same sets: one-shot least squares, STLSQ and the all-terms fit.

All three get the same recordings, the same noise estimate and the same registry as the workflow, one shape per effect.
An axis or an arm brings its regressors, a drop what a little of each effect changes on the fall as given.  Cloth is
left out: there each column is a simulation, and so is each of the workflow's own steps.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....sim.effects.body.body_registry import BODY_EFFECTS
from ....sim.effects.effect import Parameter
from ..fall.drop import height
from ..fall.fit import RELEASE, fit_drops, table_of
from ..fall.recording import drop_of
from ..joints.block import effect_blocks
from ..joints.gram import assemble
from ..joints.log import read_logs
from ..joints.opening import columns_of, rigid_model
from ..joints.search import bounded_solve
from ..joints.workflow import one_shape_each
from ..measurement import MeasurementSet, load_set
from .score import interval

Named = set[tuple[str, str]]
METHODS = ("one-shot least squares", "STLSQ", "all terms")
QUESTIONS = {"single": "exact, single >= 2", "two": "exact, two effects", "none": "false alarm"}
KEEP = 0.7  # an effect is named where its load exceeds this part of the residual left; best for them on tuning seeds
LITTLE = {"linear_drag": 1e-3, "quadratic_drag": 1e-4, "buoyancy": 1e-3, "gain_error": 1e-3}


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Normal equations of all hypotheses at once.

    Attributes:
        A, r: (K, K) and (K,), weighted.
        energy: weighted sum of squares to be explained.
        keys: effect and target of each hypothesis.
        spans: its columns.
        parameters: of all columns.
    """

    A: np.ndarray
    r: np.ndarray
    energy: float
    keys: Sequence[tuple[str, str]]
    spans: Sequence[slice]
    parameters: Sequence[Parameter]


def compare(cases: list[tuple[str, int]], out: Path, say: Callable[[str], None]) -> list[str]:
    """Exact-set rate of each method on single effects of size 2 and more and on pairs, and its false alarms."""
    wanted = [(s, k) for s, k in cases if s != "cloth"]
    tally: dict[tuple[str, str, str], list[int]] = {}
    for count, (system, seed) in enumerate(wanted):
        name = f"{system}_{seed:05d}"
        truth = json.loads((out / "truth" / f"{name}.json").read_text())
        kind = truth["kind"]
        if kind not in QUESTIONS or (kind == "single" and truth["effects"][0]["size"] < 2.0):
            continue
        hidden = {(e["name"], e["target"]) for e in truth["effects"]}
        for method, said in zip(METHODS, _solve(out / "sets" / name), strict=True):
            hits = tally.setdefault((system, method, kind), [0, 0])
            hits[0] += bool(said) if kind == "none" else said == hidden
            hits[1] += 1
        if count % 10 == 9:
            say(f"ablations {count + 1}/{len(wanted)}")
    lines = []
    for (system, method, kind), (hits, n) in sorted(tally.items(), key=lambda x: (x[0][0], METHODS.index(x[0][1]))):
        low, high = interval(hits, n)
        label = f"{method}: {QUESTIONS[kind]}"
        lines.append(f"{label:52s} {system:6s} {hits:4d}/{n:4d}  {hits / n:.3f} ({low:.3f} to {high:.3f})")
    return lines


def _solve(folder: Path) -> tuple[Named, Named, Named]:
    measured = load_set(folder)
    problem = _of_drops(measured) if measured.system == "fall" else _of_joints(measured)
    A, r, energy = problem.A, problem.r, problem.energy
    size = np.sqrt(np.diag(A)) + 1e-12
    whole = bounded_solve(A, r, list(problem.parameters))
    left = energy - 2 * float(whole @ r) + float(whole @ A @ whole)
    every = np.array([abs(t) * s for t, s in zip(whole, size, strict=True)])
    noise = np.sqrt(max(left, 1e-12))
    all_terms = {k for k, s in zip(problem.keys, problem.spans, strict=True) if np.any(every[s] > KEEP * noise)}
    alone = set()
    for key, s in zip(problem.keys, problem.spans, strict=True):  # each effect on its own
        theta = np.linalg.lstsq(A[s, s], r[s], rcond=None)[0]
        if theta @ r[s] > KEEP * energy:
            alone.add(key)
    return alone, _stlsq(problem, size, KEEP * noise), all_terms


def _of_joints(measured: MeasurementSet) -> Problem:
    names = columns_of(measured)
    model = rigid_model(measured, len(names.q))
    logs = [log for log in read_logs(list(measured.episodes), names, model) if log.role != "heldout"]
    blocks = one_shape_each(effect_blocks(model, logs, measured.system))
    gram = assemble(blocks, logs)
    yy = gram.yy.sum(axis=0)
    weight = gram.rows.sum(axis=0) / np.maximum(yy, 1e-30)
    return Problem(
        A=np.einsum("c,cij->ij", weight, gram.G.sum(axis=0)),
        r=weight @ gram.b.sum(axis=0),
        energy=float(weight @ yy),
        keys=[b.key for b in blocks],
        spans=gram.spans,
        parameters=[p for b in blocks for p in b.parameters],
    )


def _of_drops(measured: MeasurementSet) -> Problem:
    """What a little of each effect changes; wind is a quadratic drag until it is fitted, so it is left out."""
    drops = [drop_of(measured, e) for e in measured.fitted]
    given = fit_drops(drops, (), "together")
    duration = max(float(d.t[-1]) for d in drops) + RELEASE + 0.1
    columns = []
    for name in (*LITTLE, "delay"):
        little = LITTLE.get(name, 1e-3)
        values = {} if name == "delay" else {name: {BODY_EFFECTS[name].parameters[0].name: little}}
        table, scale = table_of(values, duration)
        plain, _ = table_of({}, duration)
        late = little if name == "delay" else 0.0
        parts = [scale * height(d.t, table, 0.0, late)[0] - height(d.t, plain, 0.0, 0.0)[0] for d in drops]
        columns.append(np.concatenate([x - x.mean() for x in parts]) / little)  # every height of release is free
    X, y = np.stack(columns, axis=1), np.concatenate([r - r.mean() for r in given.residuals])
    weight = len(y) / max(float(y @ y), 1e-30)
    keys = [(name, "body") for name in (*LITTLE, "delay")]
    return Problem(
        A=weight * X.T @ X,
        r=weight * X.T @ y,
        energy=float(len(y)),
        keys=keys,
        spans=[slice(i, i + 1) for i in range(len(keys))],
        parameters=[
            *(BODY_EFFECTS[n].parameters[0] for n in LITTLE),
            Parameter(name="time", unit="s", lower=-1.0, upper=1.0),
        ],
    )


def _stlsq(problem: Problem, size: np.ndarray, level: float) -> Named:
    """Sequentially thresholded least squares on columns scaled to unit size."""
    A, r = problem.A, problem.r
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
    return {key for key, s in zip(problem.keys, problem.spans, strict=True) if np.any(active[s] & (theta[s] != 0))}

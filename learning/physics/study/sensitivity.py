"""What a clip shows of each parameter, measured before anything is learned.

For gowns drawn from the whole range, the clip is differentiated with respect to the parameters, and the Fisher
information of the depth images under a depth camera's noise gives the smallest standard deviation with which any
method could know a parameter: when the others are known, and when they are not (Cramer-Rao).

Derivatives need care, because the static equilibrium is not quite smooth in the parameters: folds may sit elsewhere.

- Damping and air do not enter the static equilibrium, so their derivatives are clean.
- Multiply mass, elastic, bending, damping and air drag by one factor: the gown hangs the same and, but for the clamp
  of known mass, falls the same.  So the derivative along that direction is minus the derivative with respect to the
  clamp's mass, clean as well; and the one with respect to mass alone follows from it and the others.
- Elastic and bending: the slope of a line through several steps; how much the steps differ is told as `rough`.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.scene.gown import GOWNS, GownSpec
from ..clips.camera import standard_camera
from ..clips.depth_noise import SIGMA
from ..clips.parameters import HIGH, LOW, NAMES, SHOWN, to_spec
from ..engine.fall import CLAMP_MASS, cut_of, fall, rest

STEPS = (-0.03, -0.02, -0.01, 0.01, 0.02, 0.03)  # for the slopes through the static equilibrium, on the [0, 1] scale
CLEAN = 0.01  # step for what does not enter the static equilibrium
EDGE = 0.03  # a pixel that jumps by more has passed a fold or an edge and has no derivative [m]
SCALED = [NAMES.index(name) for name in ("mass", "elastic", "bending", "damping", "air_drag")]


@dataclass(frozen=True, kw_only=True)
class Row:
    """What the clip shows of one parameter: medians over gowns, on the [0, 1] scale.

    Attributes:
        name: of the parameter.
        moves: root mean square change of the depth, per whole range [mm].
        known: smallest standard deviation if all others were known.
        unknown: the same if none is known.
        percent: `unknown` as a share of the parameter's value [%].
        worst: `unknown` at the 90th percentile of gowns.
        rough: by how much folds that sit elsewhere mislead who reads this parameter along its slope, root mean
            square over changes of up to 3 % of the range.
        like: the parameter whose effect looks most alike.
        alike: correlation with it, between -1 and 1.
    """

    name: str
    moves: float
    known: float
    unknown: float
    percent: float
    worst: float
    rough: float
    like: str
    alike: float


@dataclass(frozen=True, kw_only=True)
class Study:
    """The table, with and without the clamp.

    Attributes:
        rows: one for each parameter, with the clamp.
        scale_known: smallest standard deviation along the common factor of mass, elastic, bending, damping and air
            drag, in per cent, with the clamp.
        scale_free: largest change of the clip when, without a clamp, all five grow by a half [mm]: 0 is "not shown".
        gowns: how many were looked at.
        seed: of the draw.
    """

    rows: tuple[Row, ...]
    scale_known: float
    scale_free: float
    gowns: int
    seed: int

    def write(self, path: str | Path) -> None:
        """As JSON."""
        Path(path).write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")


def derivatives(spec: GownSpec) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How the clip of one gown depends on the shown parameters.

    Returns:
        (5, P) derivative of the depth in units of the camera's noise per whole range, in the order of `SHOWN`;
        (5, P) the same [m]; (5,) what is misread along the slopes, on the [0, 1] scale, see `Row.rough`.
    """
    mesh, _ = cut_of(spec)
    camera = standard_camera()
    ranges = np.log(HIGH / LOW)
    start = rest(spec)

    def depth(gown: GownSpec, hung: np.ndarray, clamp: float = CLAMP_MASS) -> np.ndarray:
        return np.array([camera.look(mesh, x) for x in fall(gown, hung, clamp=clamp)]).ravel()

    def grown(name: str, step: float) -> GownSpec:
        factor = float(np.exp(step * ranges[NAMES.index(name)]))
        changes: dict[str, Any] = {name: getattr(spec, name) * factor}
        return replace(spec, **changes)

    here = depth(spec, start)
    slope: dict[str, np.ndarray] = {}
    left: dict[str, float] = {}
    for name in ("damping", "air_drag"):
        slope[name] = (depth(grown(name, CLEAN), start) - depth(grown(name, -CLEAN), start)) / (2 * CLEAN)
    for name in ("mass", "elastic", "bending"):  # mass for its roughness only
        gowns = [grown(name, step) for step in STEPS]
        change = np.array([depth(gown, rest(gown)) for gown in gowns]) - here
        steps = np.array(STEPS)
        change[np.abs(change) > EDGE] = np.nan
        slope[name] = steps @ change / (steps @ steps)
        whole = np.isfinite(slope[name])
        read = change[:, whole] @ slope[name][whole] / (slope[name][whole] @ slope[name][whole])
        left[name] = float(np.sqrt(np.mean((read - steps) ** 2)))
    by_clamp = (depth(spec, start, CLAMP_MASS * np.exp(CLEAN)) - depth(spec, start, CLAMP_MASS * np.exp(-CLEAN))) / (
        2 * CLEAN
    )
    per_log = {name: slope[name] / ranges[NAMES.index(name)] for name in slope if name != "mass"}
    slope["mass"] = (-by_clamp - sum(per_log.values())) * ranges[NAMES.index("mass")]
    rows = np.array([slope[NAMES[k]] for k in SHOWN])
    good = np.isfinite(rows).all(axis=0) & np.isfinite(here)
    good &= (np.abs(rows) * CLEAN < EDGE).all(axis=0)
    rows, here = rows[:, good], here[good]
    rough = np.array([left.get(NAMES[k], 0.0) for k in SHOWN])
    return rows / (SIGMA * here**2), rows, rough


def scale_free(spec: GownSpec) -> float:
    """Largest change of the vertices when all five grow by a half and no clamp hangs on the gown [m]."""
    changes: dict[str, Any] = {NAMES[k]: 1.5 * getattr(spec, NAMES[k]) for k in SCALED}
    bigger = replace(spec, **changes)
    return float(np.abs(fall(spec, rest(spec), clamp=0.0) - fall(bigger, rest(bigger), clamp=0.0)).max())


def study(gowns: int = 20, seed: int = 0) -> Study:
    """The table over `gowns` gowns drawn from the whole range."""
    ranges = np.log(HIGH / LOW)[list(SHOWN)]
    # along the common factor every parameter moves by the same share of its value
    common = 1.0 / ranges
    moves, known, unknown, rough, scale, cosines = [], [], [], [], [], []
    for number in range(gowns):
        unit = np.random.default_rng([seed, 11, number]).uniform(0.05, 0.95, len(NAMES))
        scaled, metres, rest_of_slope = derivatives(to_spec(unit, GOWNS["medium"]))
        information = scaled @ scaled.T
        moves.append(np.sqrt((metres**2).mean(axis=1)))
        known.append(1.0 / np.sqrt(np.diag(information)))
        unknown.append(np.sqrt(np.diag(np.linalg.inv(information))))
        scale.append(1.0 / np.sqrt(common @ information @ common))
        cosines.append(information * np.outer(known[-1], known[-1]))
        rough.append(rest_of_slope)
    alike = np.median(cosines, axis=0) - np.eye(len(SHOWN))
    rows = []
    for name in NAMES:
        if NAMES.index(name) not in SHOWN:
            rows.append(
                Row(
                    name=name,
                    moves=0.0,
                    known=np.inf,
                    unknown=np.inf,
                    percent=np.inf,
                    worst=np.inf,
                    rough=0.0,
                    like="",
                    alike=0.0,
                )
            )
            continue
        n = SHOWN.index(NAMES.index(name))
        partner = int(np.argmax(np.abs(alike[n])))
        free = np.array(unknown)[:, n]
        rows.append(
            Row(
                name=name,
                moves=float(np.median(np.array(moves)[:, n]) * 1e3),
                like=NAMES[SHOWN[partner]],
                known=float(np.median(np.array(known)[:, n])),
                unknown=float(np.median(free)),
                percent=float(100 * np.expm1(np.median(free) * ranges[n])),
                worst=float(np.quantile(free, 0.9)),
                rough=float(np.median(np.array(rough)[:, n])),
                alike=float(alike[n, partner]),
            )
        )
    base = to_spec(np.full(len(NAMES), 0.5), GOWNS["medium"])
    return Study(
        rows=tuple(rows),
        scale_known=float(100 * np.median(scale)),
        scale_free=scale_free(base) * 1e3,
        gowns=gowns,
        seed=seed,
    )


def report(result: Study) -> str:
    """The table as Markdown."""
    lines = [
        f"{result.gowns} gowns; camera noise {SIGMA * 1e3:g} mm at 1 m; all on the [0, 1] scale",
        "",
        "| parameter | moves the clip [mm] | sd, others known | sd, others unknown | in % | worst tenth | fold "
        "roughness | looks like |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in result.rows:
        if not row.moves:
            lines.append(f"| {row.name} | 0 | not shown | not shown | | | | |")
        else:
            rough = f"{row.rough:.4f}" if row.rough else "none"
            lines.append(
                f"| {row.name} | {row.moves:.0f} | {row.known:.4f} | {row.unknown:.4f} | {row.percent:.2f} | "
                f"{row.worst:.4f} | {rough} | {row.like} ({row.alike:+.2f}) |"
            )
    lines += [
        "",
        f"Common factor of all but friction: known to {result.scale_known:.2f} % with the clamp of "
        f"{CLAMP_MASS * 1e3:g} g; without it a factor of 1.5 moves no vertex by more than "
        f"{result.scale_free:.2g} mm.",
    ]
    return "\n".join(lines)

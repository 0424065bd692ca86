"""Hidden cases for an axis and for arms: a motion, the rigid load by pinocchio, effects, noise, quantisation."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.interpolate import CubicSpline, make_interp_spline

from .case import STEPS, Truth, coloured, draw_kind, draw_size, moves, multisine
from .joint_loads import INSIDE, OUTSIDE, Drawn, Trace, shape_of

ROBOTS = ("ur5", "ur10", "panda", "z1", "xarm7")
# a gap or a missing tool (1: half the link) takes away what there is; no drive pulls the other way than it is told to
MOST = {"backlash": 1.0, "wrong_tool": 1.9, "gain_error": 0.95, "load_friction": 10.0}
LEAST = 0.49  # size over the noise below which nothing is hidden: another effect is drawn instead
DRY = {"coulomb_friction", "asymmetric_friction", "stribeck_friction"}
ALIKE = {
    **{n: DRY for n in DRY},
    **{n: {"payload", "wrong_tool"} for n in ("payload", "wrong_tool")},
    **{n: {"offset", "spring"} for n in ("offset", "spring")},
}  # of which one set holds at most one
AXIS_EFFECTS = tuple(n for n in INSIDE if n not in ("gain_error", "armature"))  # both are a mass on an axis


def write_joint_case(system: str, seed: int, folder: Path) -> Truth:
    """Write one set for `axis` or `arm` into `folder` and return what it hides."""
    rng = np.random.default_rng([seed, 0 if system == "axis" else 1])
    kind = draw_kind(rng)
    rate = float(rng.choice([100.0, 200.0, 250.0, 500.0]))
    episodes = int(rng.integers(3, 6))
    duration = rng.uniform(8.0, 16.0)
    robot = None if system == "axis" else str(rng.choice(ROBOTS))
    truth = Truth(system=system, seed=seed, kind=kind, robot=robot)
    arm = None
    t = np.arange(0.0, duration, 1.0 / rate)
    if system == "axis":
        mass = rng.uniform(2.0, 120.0)
        motions = [_derive(t, rng.uniform(0.1, 0.4) * _path(rng, t)[:, None]) for _ in range(episodes)]
        actual = mass * (rng.choice([-1, 1]) * rng.uniform(0.08, 0.3) + 1.0 if kind == "recalibration" else 1.0)
        loads = [actual * a for _, _, a in motions]
        names, header = ["axis"], {"system": "axis", "mass": round(float(mass), 6)}
        if kind == "recalibration":
            truth.effects = [_mass("axis", actual - round(float(mass), 6))]
    else:
        motions, loads, names, arm = _arm(rng, robot, t, episodes, kind, truth)
        header = {"system": "arm", "robot": robot}
    clean = np.sqrt(np.mean(np.concatenate(loads) ** 2, axis=0))
    noise = np.maximum(clean, 0.1 * clean.max()) * rng.uniform(0.02, 0.06)
    added = _effects(rng, system, kind, truth, t, motions, loads, noise, names, arm)
    position_step = rng.choice([0.0, 2e-5, 5e-5]) * (0.2 if system == "axis" else 1.0)
    position_noise = rng.choice([0.0, 1e-5]) * (0.2 if system == "axis" else 1.0)
    give_speed = rng.random() < 0.6
    load_step = noise * rng.choice(STEPS)
    entries = []
    for e, ((q, v, _), u) in enumerate(zip(motions, loads, strict=True)):
        total = u + added[e]
        total = total + np.stack([coloured(rng, len(t), t[1], s) for s in noise], axis=1)
        total = np.where(load_step > 0, np.round(total / np.where(load_step > 0, load_step, 1)) * load_step, total)
        q = q + position_noise * rng.normal(size=q.shape)
        q = np.round(q / position_step) * position_step if position_step > 0 else q
        v = v + 3e-4 * np.abs(v).max(axis=0) * rng.normal(size=v.shape)
        n = q.shape[1]
        table = {"t": t}
        if system == "axis":
            table |= {"q": q[:, 0], **({"dq": v[:, 0]} if give_speed else {}), "force": total[:, 0]}
        else:
            table |= {f"q{j + 1}": q[:, j] for j in range(n)}
            table |= {f"dq{j + 1}": v[:, j] for j in range(n)} if give_speed else {}
            table |= {f"tau{j + 1}": total[:, j] for j in range(n)}
        file = folder / f"episode_{e + 1}.csv"
        np.savetxt(
            file, np.stack(list(table.values()), axis=1), delimiter=",", header=",".join(table), comments="", fmt="%.8g"
        )
        entries.append({"file": file.name, "role": "heldout" if e >= episodes - max(1, episodes // 3) else "fit"})
    (folder / "measurement.yaml").write_text(yaml.safe_dump({**header, "episodes": entries}, sort_keys=False))
    return truth


def _path(rng: np.random.Generator, t: np.ndarray) -> np.ndarray:
    return (
        multisine(rng, t, rng.uniform(0.08, 0.2), int(rng.integers(3, 7)))
        if rng.random() < 0.6
        else moves(rng, t, rng.uniform(0.8, 2.5))
    )


def _derive(t: np.ndarray, q: np.ndarray):
    # differences of neighbours would lose a hundredth of the acceleration at 3 Hz and 100 samples a second
    path = make_interp_spline(t, q, k=5)
    return q, path(t, 1), path(t, 2)


def _arm(rng, robot, t, episodes, kind, truth):
    motions, names, (pin, model) = arm_motions(rng, robot, t, episodes)
    actual = model.copy()
    if kind == "recalibration":
        j = int(rng.choice([i for i in range(2, model.njoints - 1) if model.inertias[i].mass > 0.3]))
        factor = 1.0 + rng.choice([-1, 1]) * rng.uniform(0.15, 0.4)
        actual.inertias[j] = pin.Inertia(
            model.inertias[j].mass * factor, model.inertias[j].lever, model.inertias[j].inertia * factor
        )
        truth.effects = [_mass(names[j - 1], model.inertias[j].mass * (factor - 1.0))]
    loads = [inverse_dynamics(pin, actual, m) for m in motions]
    truth.note = str(len(names))
    return motions, loads, names, (pin, model)


def arm_motions(rng: np.random.Generator, robot: str, t: np.ndarray, episodes: int):
    """Motions (q, dq, ddq), each (T, n), of a robot of `ROBOTS`; its joints' names; pinocchio and its model."""
    import sys

    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

    base = Path(sys.prefix) / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
    base = base / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
    file = {
        "ur5": "ur_description/urdf/ur5_robot.urdf",
        "ur10": "ur_description/urdf/ur10_robot.urdf",
        "panda": "panda_description/urdf/panda.urdf",
        "z1": "z1_description/urdf/z1.urdf",
        "xarm7": "xarm_description/urdf/xarm7.urdf",
    }[robot]
    full = pin.buildModelFromUrdf(str(base / file))
    n = {"panda": 7, "xarm7": 7}.get(robot, 6)
    lock = list(range(n + 1, full.njoints))
    model = pin.buildReducedModel(full, lock, pin.neutral(full)) if lock else full
    motions = []
    low, high = model.lowerPositionLimit, model.upperPositionLimit
    low, high = (
        np.where(np.isfinite(low), np.maximum(low, -2.5), -2.5),
        np.where(np.isfinite(high), np.minimum(high, 2.5), 2.5),
    )
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    slow = rng.uniform(0.5, 1.2)
    for _ in range(episodes):
        q = np.stack(
            [
                centre[j] + 0.55 * half[j] * slow * multisine(rng, t, rng.uniform(0.06, 0.12), int(rng.integers(3, 6)))
                for j in range(n)
            ],
            axis=1,
        )
        motions.append(_derive(t, q))
    return motions, list(model.names)[1:], (pin, model)


def _mass(target: str, change: float) -> dict[str, Any]:
    """A wrong number of the model's own."""
    return {"name": "mass", "target": target, "size": float("nan"), "values": {"mass": float(change)}}


def inverse_dynamics(pin: Any, model: Any, motion: Sequence[np.ndarray]) -> np.ndarray:
    """Loads of a pinocchio model along a motion, (T, n)."""
    data = model.createData()
    return np.array([pin.rnea(model, data, np.ascontiguousarray(a), b, c) for a, b, c in zip(*motion, strict=True)])


def _effects(rng, system, kind, truth, t, motions, loads, noise, names, arm):
    """What the hidden effects add to the loads; an effect too small at its largest gives way to another draw."""
    late = None
    added = [np.zeros_like(u) for u in loads]
    used = set()
    for _ in range({"none": 0, "recalibration": 0, "single": 1, "two": 2, "outside": 1}[kind]):
        asked = (system, kind, used, t, motions, loads, noise, names, arm)
        name, target, j, load, size, values = hidden_effect(rng, *asked)
        while size < LEAST:
            name, target, j, load, size, values = hidden_effect(rng, *asked)
        used |= ALIKE.get(name, {name})
        late = (j, values["time"]) if name == "delay" else late
        for e, x in enumerate(load):
            added[e] += x
            if name == "contact":
                active = np.abs(x[:, j]) > 0
                edges = np.diff(np.concatenate([[0], active.astype(int), [0]]))
                truth.intervals += [
                    (f"episode_{e + 1}", float(t[a]), float(t[b - 1]))
                    for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
                ]
        truth.effects.append({"name": name, "target": target, "size": size, "values": values})
    if late:  # a late reading is late for whatever acts beside it
        j, lag = late
        for x, u in zip(added, loads, strict=True):
            x[:, j] += _late(t, x[:, j] - _late(t, u[:, j], lag), lag)
    return added


def hidden_effect(
    rng: np.random.Generator,
    system: str,
    kind: str,
    used: set[str],
    t: np.ndarray,
    motions: Sequence[Sequence[np.ndarray]],
    loads: Sequence[np.ndarray],
    noise: np.ndarray,
    names: Sequence[str],
    arm: Any,
) -> tuple[str, str, int, list[np.ndarray], float, dict[str, float]]:
    """Draw one effect: name, target, the joint it loads most, loads (T, n) per episode, size there, and parameters."""
    size = draw_size(rng) if kind != "outside" else float(np.exp(rng.uniform(np.log(1.5), np.log(8.0))))
    pool = OUTSIDE if kind == "outside" else (AXIS_EFFECTS if system == "axis" else (*INSIDE, "payload", "wrong_tool"))
    name = str(rng.choice([n for n in pool if n not in used]))
    if name in ("payload", "wrong_tool"):
        drawn = _body(rng, name, arm, motions)
        load = drawn.load
        j = int(np.argmax(np.sqrt(np.mean(np.concatenate(load) ** 2, axis=0)) / noise))
        target = names[-1]
    else:
        j = int(rng.integers(len(names)))
        trace = [
            Trace(t=t, q=q[:, j], v=v[:, j], a=a[:, j], u=u[:, j]) for (q, v, a), u in zip(motions, loads, strict=True)
        ]
        drawn = shape_of(name, trace, rng)
        load = [np.zeros_like(u) for u in loads]
        for x, y in zip(load, drawn.load, strict=True):
            x[:, j] = y
        target = names[j]
    rms = np.sqrt(np.mean(np.concatenate(load)[:, j] ** 2))
    scale = min(size * noise[j] / max(rms, 1e-12), MOST.get(name, np.inf))
    values = drawn.values(scale)
    if name == "delay":
        shift = min(scale * 1e-3, 0.04)
        load = [
            np.stack([_late(t, u[:, k], shift) if k == j else 0 * t for k in range(u.shape[1])], axis=1) for u in loads
        ]
        values, scale = {"time": shift}, 1.0
    size = float(scale * np.sqrt(np.mean(np.concatenate(load)[:, j] ** 2)) / noise[j])
    return name, target, j, [scale * x for x in load], size, values


def _late(t: np.ndarray, load: np.ndarray, lag: float) -> np.ndarray:
    """Change of a load (T,) that is recorded `lag` seconds late."""
    return CubicSpline(t, load)(np.maximum(t - lag, t[0])) - load


def _body(rng, name, arm, motions):
    pin, model = arm
    changed = model.copy()
    last = model.njoints - 1
    if name == "payload":
        com = np.array([rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), rng.uniform(0.0, 0.15)])
        changed.inertias[last] = model.inertias[last] + pin.Inertia(1.0, com, np.zeros((3, 3)))
        part, lever = 1.0, com
    else:
        changed.inertias[last] = pin.Inertia(
            model.inertias[last].mass * 0.5, model.inertias[last].lever, model.inertias[last].inertia * 0.5
        )
        part, lever = -0.5 * model.inertias[last].mass, model.inertias[last].lever
    load = [inverse_dynamics(pin, changed, m) - inverse_dynamics(pin, model, m) for m in motions]
    moments = {f"mass_com_{a}": part * x for a, x in zip("xyz", lever, strict=True)}
    return Drawn(load, {"mass": part, **moments})

"""Shapes the search only screened are fitted: thresholds, Stribeck speeds, gaps, a payload's centre of mass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from ....sim.effects.joint.arm_geometry import GEOMETRY
from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from .block import Block, body_block, joint_block
from .lag import at_lag
from .log import JointLog
from .rigid import RigidModel

NEAR = 2e-3  # [rad, kg, kg m] within which an angle's columns are as good as at the angle itself


def refined(chosen: list[Block], theta: np.ndarray, model: RigidModel, logs: list[JointLog]) -> list[Block]:
    """The same blocks with their shapes fitted, one after the other, linear parameters projected out."""
    out = list(chosen)
    bodies = [(b, x) for b, x in zip(chosen, _parts(chosen, theta), strict=True) if b.term and not b.term.during]
    at = 0
    for i, block in enumerate(chosen):
        values = theta[at : at + len(block.parameters)]
        at += len(block.parameters)
        if block.term is not None and len(values) == 4 and abs(values[0]) > 1e-6:
            com = np.clip(values[1:] / values[0], -1.0, 1.0)
            shape = {f"com_{a}": float(x) for a, x in zip("xyz", com, strict=True)}
            out[i] = body_block(replace(block.term, shape=shape), model)
        elif block.term is not None and block.name in GEOMETRY:
            beside = [(b, x) for b, x in bodies if b.name not in GEOMETRY or chosen.index(b) < i]
            out[i] = exact_at(block, values, model, beside)
        elif block.name == "delay":
            out[i] = at_lag(block, float(values[0]))
        elif block.shape and block.name in JOINT_EFFECTS:
            out[i] = fit_shape(block, [b for k, b in enumerate(out) if k != i], model, logs)
    return out


def exact_at(
    block: Block, values: np.ndarray, model: RigidModel, beside: list[tuple[Block, np.ndarray]] | None = None
) -> Block:
    """A tilt's or a zero's block with columns that are exact at some angles, not at none; itself near there.

    Args:
        block: of the tilt, or of the zero.
        values: (p,) the angles [rad].
        model: as the user gave it.
        beside: what else is found of the bodies, and its numbers: a payload hangs from a tilted base, too.
    """
    if block.term is None:
        return block
    shape = _named(block, values)
    for other, numbers in beside or []:
        if other.term is not None:
            model = model.patched(other.term, _named(other, numbers))
            shape |= {f"{other.name} of {other.target}: {name}": x for name, x in _named(other, numbers).items()}
    known = {name: block.shape.get(name, 0.0) for name in {*shape, *block.shape}}
    if all(abs(shape.get(name, 0.0) - x) < NEAR for name, x in known.items()):
        return block
    return body_block(replace(block.term, shape=shape), model)


def _named(block: Block, values: np.ndarray) -> dict[str, float]:
    return {p.name: float(x) for p, x in zip(block.parameters, values, strict=True)}


def _parts(blocks: list[Block], theta: np.ndarray) -> list[np.ndarray]:
    """The numbers of each block."""
    return np.split(theta, np.cumsum([len(b.parameters) for b in blocks])[:-1]) if blocks else []


def fit_shape(block: Block, others: list[Block], model: RigidModel, logs: list[JointLog]) -> Block:
    """One block with its shape fitted, the linear parameters of all projected out."""
    channel = block.channels[0]
    free = [p.name for p in block.shape_parameters if p.name != "side"]
    start = np.array([block.shape[name] for name in free])
    span = float(max(np.ptp(log.q[:, channel]) for log in logs))
    unit = np.array([span if name == "threshold" else max(abs(block.shape[name]), 1e-9) for name in free])
    problem = _ShapeProblem(block, others, logs)

    def shape_of(x: np.ndarray) -> dict[str, float]:
        return {**block.shape, **dict(zip(free, (float(v) for v in x * unit), strict=True))}

    def rss(x: np.ndarray) -> float:
        return problem.rss(shape_of(x))

    first = rss(start / unit)
    steps = np.array([0.12 if name == "threshold" else 0.4 for name in free])
    best = minimize(
        rss,
        start / unit,
        method="Nelder-Mead",
        options={
            "initial_simplex": np.vstack([start / unit, start / unit + np.diag(steps)]),
            "xatol": 1e-3,
            "fatol": 1e-4 * first,
            "maxfev": 60,
        },
    )
    if best.fun >= first:
        return block
    return joint_block(JOINT_EFFECTS[block.name], model, channel, shape_of(best.x), block.trials)


class _ShapeProblem:
    """Squares a block leaves of one channel's residual as a function of its shape."""

    def __init__(self, block: Block, others: list[Block], logs: list[JointLog]) -> None:
        self._block, self._logs, self._effect = block, logs, JOINT_EFFECTS[block.name]
        self._channel = channel = block.channels[0]
        beside = [b for b in others if channel in b.channels]
        table = np.concatenate(
            [
                np.column_stack(
                    [log.residual[log.inner, channel], *(b.build(log)[:, b.channels.index(channel), :] for b in beside)]
                )
                for log in logs
            ]
        )
        y, X = table[:, 0], table[:, 1:]
        self._others = np.linalg.qr(X)[0] if X.shape[1] else np.zeros((len(y), 0))
        self._y = y - self._others @ (self._others.T @ y)

    def rss(self, shape: dict[str, float]) -> float:
        """Sum of squares left with the best linear parameters within their bounds."""
        y = self._y
        if any(p.lower > shape[p.name] or p.upper < shape[p.name] for p in self._block.shape_parameters):
            return float(y @ y)
        Z = np.concatenate([log.columns(self._effect, self._channel, shape) for log in self._logs])
        Z = Z - self._others @ (self._others.T @ Z)
        theta = np.linalg.lstsq(Z, y, rcond=1e-8)[0]
        linear = self._effect.linear
        if any(not p.lower <= v <= p.upper for p, v in zip(linear, theta, strict=True)):
            theta = np.array([np.clip(v, p.lower, p.upper) for p, v in zip(linear, theta, strict=True)])
        left = y - Z @ theta
        return float(left @ left)

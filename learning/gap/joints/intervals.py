"""How sure the numbers of a named set are: least squares under noise with a memory, shapes included.

The least-squares estimate errs by inv(A) s, where A are the normal equations and s = sum_t x(t) w e(t).  Noise that
does not depend on the motion gives s the covariance sum_f X(f)* X(f)' w^2 S(f): the columns' own spectrum times that of
the noise.  S is read off what the fit leaves, log by log (noise differs from one to the next) and band by band, and
divided by the part of the band that the fit could not take up itself.  A slow column (an offset, a payload) rests on
the few lowest bands, a fast one on many: how many independent numbers its variance was estimated from follows
(Satterthwaite), and with it Student's t for its interval.

Columns of numbers that enter nonlinearly (a threshold, a Stribeck speed) are derivatives, so what is not known about
them widens the others' intervals too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.stats import t as student

from ....sim.effects.effect import Parameter
from ....sim.effects.joint.joint_registry import JOINT_EFFECTS
from ..findings import Value
from .block import Block, joint_block
from .log import JointLog
from .rigid import RigidModel

LEVEL = 0.95
FEWEST = 6.0  # real numbers that the variance of the noise in one band is estimated from, at least
GROWTH = 0.25  # width of a band over its lower edge
AT_BOUND = "the data would have it beyond what is physical, so the interval does not hold"
STEP = 0.02  # of a nonlinear number, for its derivative


@dataclass(frozen=True, kw_only=True)
class Intervals:
    """Half-widths of 95 % intervals.

    Attributes:
        linear: (k,) of the linear parameters, in order; infinite where the data do not determine one.
        shape: of the nonlinear ones, (block, name) -> half-width.
    """

    linear: np.ndarray
    shape: dict[tuple[int, str], float]


def intervals(
    blocks: Sequence[Block],
    theta: np.ndarray,
    weight: np.ndarray,
    logs: list[JointLog],
    model: RigidModel | None = None,
    ridge: np.ndarray | None = None,
) -> Intervals:
    """Intervals of a fitted set.

    Args:
        blocks: the set.
        theta: (k,) its linear parameters.
        weight: (C,) of the channels in the fit.
        logs: what it was fitted to.
        model: of the joints; without, the blocks have no nonlinear numbers.
        ridge: (k,) what was known of the linear parameters beforehand, in the units of the normal equations.
    """
    k = len(theta)
    if k == 0:
        return Intervals(linear=np.zeros(0), shape={})
    free = [] if model is None else [(i, name) for i, b in enumerate(blocks) for name in _free_shape(b)]
    channels = sorted({c for b in blocks for c in b.channels})
    columns, left = _columns(blocks, theta, logs, model, free, channels)
    square = np.sum([np.einsum("tcp,c->p", X**2, weight[channels]) for X in columns], axis=0)
    if ridge is not None:
        square[:k] += ridge
    size = np.sqrt(square) + 1e-30
    columns = [X / size for X in columns]
    A = np.sum([np.einsum("tcp,tcq,c->pq", X, X, weight[channels]) for X in columns], axis=0)
    if ridge is not None:
        A[np.arange(k), np.arange(k)] += ridge / size[:k] ** 2
    inverse = np.linalg.pinv(A, rcond=1e-10, hermitian=True)
    half = np.zeros((2, k + len(free)))  # variance, and the same squared over what it was estimated from
    for (j, c), (X, y, log) in product(enumerate(channels), zip(columns, left, logs, strict=True)):
        w = weight[c]
        for S, spread, numbers in _bands(X[:, j], y[:, j], inverse, w, log.dt):
            part = w**2 * S * np.einsum("pi,ij,pj->p", inverse, spread, inverse)
            half[0] += part
            half[1] += part**2 / numbers
    freedom = half[0] ** 2 / np.maximum(half[1], 1e-300)
    width = student.ppf(0.5 + LEVEL / 2.0, np.maximum(freedom, 1.0)) * np.sqrt(half[0]) / size
    return Intervals(linear=width[:k], shape={key: float(h) for key, h in zip(free, width[k:], strict=True)})


def _columns(
    blocks: Sequence[Block],
    theta: np.ndarray,
    logs: list[JointLog],
    model: RigidModel | None,
    free: list[tuple[int, str]],
    channels: list[int],
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Per log: derivatives (T, C, P) by every number of the set, the nonlinear ones last, and what is left (T, C)."""
    k, spans = len(theta), np.cumsum([0, *(len(b.parameters) for b in blocks)])
    columns, left = [], []
    for log in logs:
        X = np.zeros((len(log.t[log.inner]), len(channels), k + len(free)))
        for i, b in enumerate(blocks):
            X[:, [channels.index(c) for c in b.channels], spans[i] : spans[i + 1]] = b.build(log)
        y = log.residual[log.inner][:, channels] - X[:, :, :k] @ theta
        for j, (i, name) in enumerate(free):
            b = blocks[i]
            assert model is not None
            X[:, channels.index(b.channels[0]), k + j] = _slope(b, name, theta[spans[i] : spans[i + 1]], model, log)
        columns.append(X)
        left.append(y)
    return columns, left


def value_within(parameter: Parameter, unit: str, value: float, low: float, high: float, doubt: str = "") -> Value:
    """A fitted number with its interval, which ends where the number is bounded."""
    low, high = max(float(low), parameter.lower), min(float(high), parameter.upper)
    doubt = doubt if parameter.lower < value < parameter.upper else AT_BOUND
    return Value(name=parameter.name, unit=unit, value=float(value), low=low, high=high, doubt=doubt)


def _bands(
    columns: np.ndarray, left: np.ndarray, inverse: np.ndarray, weight: float, dt: float
) -> list[tuple[float, np.ndarray, float]]:
    """Per band of one log's frequencies: power of the noise, products of the columns (P, P), numbers it rests on."""
    n = len(left)
    count = np.full(n // 2 + 1, 2.0)
    count[0] = 1.0
    if n % 2 == 0:
        count[-1] = 1.0
    f = np.fft.rfftfreq(n, dt)
    X = np.fft.rfft(columns, axis=0) * np.sqrt(count / n)[:, None]
    power = np.abs(np.fft.rfft(left)) ** 2 * count / n
    taken = weight * np.einsum("fp,pq,fq->f", X.conj(), inverse, X).real
    out, start = [], 0
    while start < len(f):
        stop = start
        numbers = 0.0
        while stop < len(f) and (numbers < FEWEST or f[stop] < (1.0 + GROWTH) * f[start]):
            numbers += max(float(count[stop] - taken[stop]), 0.0)
            stop += 1
        if len(f) - stop < 3:
            numbers += float(np.sum(np.maximum(count[stop:] - taken[stop:], 0.0)))
            stop = len(f)
        band = slice(start, stop)
        spread = np.einsum("fp,fq->pq", X[band].conj(), X[band]).real
        out.append((float(power[band].sum()) / max(numbers, 1e-9), spread, max(numbers, 1.0)))
        start = stop
    return out


def _free_shape(block: Block) -> list[str]:
    if block.name not in JOINT_EFFECTS or block.term is not None:
        return []
    return [p.name for p in block.shape_parameters if p.name != "side"]


def _slope(block: Block, name: str, theta: np.ndarray, model: RigidModel, log: JointLog) -> np.ndarray:
    """Change of a block's load with one of its nonlinear numbers, (T_inner,)."""
    joint, x = block.channels[0], block.shape[name]
    step = STEP * (float(np.ptp(log.q[:, joint])) if name == "threshold" else abs(x))
    sides = []
    for s in (step, -step):
        moved = joint_block(JOINT_EFFECTS[block.name], model, joint, {**block.shape, name: x + s}, 1)
        sides.append(moved.build(log)[:, 0, :] @ theta)
    return (sides[0] - sides[1]) / (2.0 * step)

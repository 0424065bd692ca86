"""Rates of an arm's joints for a velocity of its hand: damped least squares within the joints' limits, compiled."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import njit

_DAMPING = 0.04  # least squares damping at a singularity [m per rad]
_SINGULAR = 0.06  # smallest singular value below which damping sets in
_TURN = 0.15  # what an error in turning counts once joints at their limits leave no exact solution [m/rad]
_AT_LIMIT = 0.05  # a joint this near to its limit that is to go beyond it is taken out [rad]
_SWEEPS = 30  # over all pairs of rows at most; four to six suffice
_SQUARE = 1e-14  # cosine below which two rows are at right angles


@njit()
def damped_rates(
    jacobian: np.ndarray, velocity: np.ndarray, q: np.ndarray, joints: np.ndarray, centring: float, dt: float
) -> np.ndarray:
    """Joint rates (n,) [rad/s] that come nearest to a velocity of the hand, slower as a whole if a joint is too slow.

    The singular values of the Jacobian say how much each direction is damped.  What the hand leaves free draws the
    joints to their rest.  A joint that would go through its limit keeps the rate it may have; the others do the rest.

    Args:
        jacobian: (6, n) of the hand, linear before angular.
        velocity: (6,) along the same axes [m/s, rad/s].
        q: (n,) [rad].
        joints: (4, n) lowest and highest angle, greatest rate, angle at rest [rad, rad, rad/s, rad].
        centring: pull towards rest [1/s].
        dt: how long the rates are kept [s].
    """
    count = len(q)
    room = 0.5 / max(dt, 1e-6)  # a joint may use half of what is left to its limit in one period
    low, high = np.empty(count), np.empty(count)
    for n in range(count):
        low[n] = max(-joints[2, n], (joints[0, n] - q[n]) * room)
        high[n] = min(joints[2, n], (joints[1, n] - q[n]) * room)
    free, rates = np.ones(count, np.bool_), np.zeros(count)
    for _ in range(3):
        _solve_free(jacobian, velocity, centring * (joints[3] - q), free, rates)
        if not _take_out(q, joints, low, high, free, rates):
            break
    fastest = np.max(np.abs(rates) / joints[2])
    if fastest > 1.0:  # slower, in the same direction
        rates /= fastest
    return np.minimum(np.maximum(rates, low), high)


@njit(inline="always")
def _take_out(
    q: np.ndarray, joints: np.ndarray, low: np.ndarray, high: np.ndarray, free: np.ndarray, rates: np.ndarray
) -> bool:
    """Fix the rates of free joints that go too fast at a limit; whether there were any."""
    found = False
    for n in range(len(q)):
        within = low[n] - 1e-9 <= rates[n] <= high[n] + 1e-9
        if free[n] and not within and min(q[n] - joints[0, n], joints[1, n] - q[n]) < _AT_LIMIT:
            rates[n] = min(max(rates[n], low[n]), high[n])
            free[n] = False
            found = True
    return found


@njit(inline="always")
def _solve_free(
    jacobian: np.ndarray, velocity: np.ndarray, centring: np.ndarray, free: np.ndarray, rates: np.ndarray
) -> None:
    """Put the rates of the free joints in place that, with the fixed ones, move the hand as wanted."""
    index = np.flatnonzero(free)
    rows, rest = np.empty((6, len(index))), np.empty(6)
    for r in range(6):
        counts = _TURN if r > 2 and len(index) <= 5 else 1.0
        left = velocity[r]
        for n in range(len(free)):
            left -= jacobian[r, n] * (centring[n] if free[n] else rates[n])
        rest[r] = left * counts
        for n in range(len(index)):
            rows[r, n] = jacobian[r, index[n]] * counts
    _square_up(rows, rest)
    for n in range(len(index)):
        rates[index[n]] = centring[index[n]]
    for r in range(6):
        square = 0.0
        for n in range(len(index)):
            square += rows[r, n] * rows[r, n]
        size = math.sqrt(square)  # a singular value
        damping = _DAMPING**2 * (1.0 - min(size / _SINGULAR, 1.0) ** 2)
        for n in range(len(index)):
            rates[index[n]] += rows[r, n] * (rest[r] / (square + damping))


@njit(inline="always")
def _square_up(rows: np.ndarray, rest: np.ndarray) -> None:
    """Turn rows (6, k) and what is wanted of each (6,) until the rows are at right angles (Hestenes, one-sided Jacobi).

    Each row is then a singular value times its right singular vector: for so small a matrix this is several times
    quicker than LAPACK, and small singular values come out at least as exactly.
    """
    tiny = 1e-30 * np.sum(rows * rows) + 1e-300
    for _ in range(_SWEEPS):
        turned = False
        for i in range(5):
            for j in range(i + 1, 6):
                a, b, ab = 0.0, 0.0, 0.0
                for n in range(rows.shape[1]):
                    a += rows[i, n] * rows[i, n]
                    b += rows[j, n] * rows[j, n]
                    ab += rows[i, n] * rows[j, n]
                if abs(ab) <= max(_SQUARE * math.sqrt(a * b), tiny):
                    continue
                turned = True
                ratio = (b - a) / (2.0 * ab)
                tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.sqrt(1.0 + ratio * ratio))
                c = 1.0 / math.sqrt(1.0 + tangent * tangent)
                s = c * tangent
                for n in range(rows.shape[1]):
                    first, second = rows[i, n], rows[j, n]
                    rows[i, n], rows[j, n] = c * first - s * second, s * first + c * second
                first, second = rest[i], rest[j]
                rest[i], rest[j] = c * first - s * second, s * first + c * second
        if not turned:
            break

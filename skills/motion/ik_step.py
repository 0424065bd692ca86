"""One step of the inverse kinematics, compiled: it is taken thousands of times while a motion is planned."""

from __future__ import annotations

import math

import numpy as np

from ...sim.compiled import njit


@njit()
def next_posture(
    jacobian: np.ndarray,
    rows: np.ndarray,
    weight: np.ndarray,
    error: np.ndarray,
    drift: np.ndarray,
    damping: float,
    q: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    rounds: int,
    max_step: float,
) -> np.ndarray:
    """Angles (n,) after a step of `ik_step` from `q`, in which no joint turns by more than `max_step` [rad].

    Args:
        jacobian: (6, n) of the hand.
        rows: (k,) of it that the task takes.
        weight: (k,) of those rows.
        error: (k,), weighted.
        drift: as for `ik_step`.
        damping: the same.
        q: the same.
        lower: the same.
        upper: the same.
        rounds: the same.
        max_step: [rad].
    """
    J = np.empty((len(rows), len(q)))
    for k in range(len(rows)):
        for n in range(len(q)):
            J[k, n] = weight[k] * jacobian[rows[k], n]
    step = ik_step(J, error, drift, damping, q, lower, upper, rounds)
    share = min(1.0, max_step / max(np.max(np.abs(step)), 1e-9))
    return np.minimum(np.maximum(q + step * share, lower), upper)


@njit()
def ik_step(
    J: np.ndarray,
    error: np.ndarray,
    drift: np.ndarray,
    damping: float,
    q: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    rounds: int,
) -> np.ndarray:
    """Change (n,) of the joints that takes out an error, damped, and drifts where that leaves them free.

    Joints at a limit that the step would push further are taken out of the solve.

    Args:
        J: (k, n) rows of the task.
        error: (k,) in the units of these rows.
        drift: (n,) change wanted in the null space [rad].
        damping: added to the diagonal of J J^T, above 0.
        q: (n,) [rad].
        lower: (n,) limits [rad].
        upper: (n,) limits [rad].
        rounds: solves at most.
    """
    free = np.ones(len(q), np.bool_)
    step = _solved(J, error, drift, damping, free)
    for _ in range(rounds - 1):
        blocked = False
        for n in range(len(q)):
            if (q[n] <= lower[n] and step[n] < 0.0) or (q[n] >= upper[n] and step[n] > 0.0):
                free[n] = False
                blocked = True
        if not blocked:
            break
        step = _solved(J, error, drift, damping, free)
    return step


@njit(inline="always")
def _solved(J: np.ndarray, error: np.ndarray, drift: np.ndarray, damping: float, free: np.ndarray) -> np.ndarray:
    """The change (n,) of the free joints: drift + J^T (J J^T + damping)^-1 (error - J drift), by Cholesky."""
    rows, joints = J.shape
    L, left = np.zeros((rows, rows)), np.empty(rows)
    for i in range(rows):
        left[i] = error[i]
        for n in range(joints):
            if free[n]:
                left[i] -= J[i, n] * drift[n]
        for j in range(i + 1):
            total = damping if i == j else 0.0
            for n in range(joints):
                if free[n]:
                    total += J[i, n] * J[j, n]
            for m in range(j):
                total -= L[i, m] * L[j, m]
            L[i, j] = math.sqrt(total) if i == j else total / L[j, j]
    for i in range(rows):
        for m in range(i):
            left[i] -= L[i, m] * left[m]
        left[i] /= L[i, i]
    for i in range(rows - 1, -1, -1):
        for m in range(i + 1, rows):
            left[i] -= L[m, i] * left[m]
        left[i] /= L[i, i]
    step = np.zeros(joints)
    for n in range(joints):
        if free[n]:
            step[n] = drift[n]
            for i in range(rows):
                step[n] += J[i, n] * left[i]
    return step

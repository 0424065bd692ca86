"""The static hang: how a gown rests that is held by two vertices.

Found without simulating the seconds it takes: the gown starts gently rolled, so that it always bulges to the same
side, and is brought to rest by alternating two exact steps, with momentum.  Turn every spring to its rest length
along its present direction; then balance all springs and the weight, which is one linear system whose matrix never
changes (projective dynamics, Bouaziz et al. 2014).

Why not simply simulate with much damping, or minimise with an ordinary relaxation: a sheet has many folded states
close to each other, and a path that overshoots ends in one or the other for parameters that differ by a ten
thousandth, vertices off by 10 cm and more.  Then clips say little about parameters.  This path bends gently with the
parameters.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from numba import njit
from scipy.sparse.linalg import splu

from ...sim.cloth import GRAVITY
from ...sim.gown import GownMesh
from .springs import Springs

NEARER = 0.8  # distance of the two held vertices over their distance at rest
CURL = 1.5  # of the start: curvature of the roll about the vertical [1/m]
ROUNDS = 500
MOMENTUM = 0.98


def held_start(mesh: GownMesh, held: tuple[int, int]) -> np.ndarray:
    """Where the search for the hang starts: the gown rolled about the vertical, the outside bulging to +y.

    Args:
        mesh: rest shape.
        held: the two vertices that are held; they come to lie at y = 0, `NEARER` each other.

    Returns:
        (V, 3) [m]; the origin is midway between the held vertices.
    """
    x = mesh.vertices - mesh.vertices[list(held)].mean(axis=0)
    half = NEARER * np.abs(x[held[0], 0])
    angle, radius = x[:, 0] * CURL, 1.0 / CURL + x[:, 1]
    x[:, 0], x[:, 1] = radius * np.sin(angle), radius * np.cos(angle)
    x[:, 1] -= x[held[0], 1]
    x[held[0]], x[held[1]] = (-half, 0.0, 0.0), (half, 0.0, 0.0)
    return x


@njit(cache=True, fastmath=True)
def _turned(x, base, start, other, stiffness, rest, row, out):
    """Right-hand side of the balance into `out` (free, 3): held part and weight, and every spring at rest length."""
    out[:] = base
    for i in range(x.shape[0]):
        a = row[i]
        for q in range(start[i], start[i + 1]):
            j = other[q]
            if j < i:  # each spring once
                continue
            dx, dy, dz = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
            share = stiffness[q] * rest[q] / np.sqrt(dx * dx + dy * dy + dz * dz)
            if a >= 0:
                out[a, 0] += share * dx
                out[a, 1] += share * dy
                out[a, 2] += share * dz
            b = row[j]
            if b >= 0:
                out[b, 0] -= share * dx
                out[b, 1] -= share * dy
                out[b, 2] -= share * dz


@njit(cache=True, fastmath=True)
def _solve(begin, below, lower, diagonal, y):
    """Turn y into (L D L^T)^-1 y in place; L has a unit diagonal and its columns' lower parts are listed."""
    n = len(diagonal)
    for c in range(n):
        y0, y1, y2 = y[c, 0], y[c, 1], y[c, 2]
        for q in range(begin[c], begin[c + 1]):
            k = below[q]
            y[k, 0] -= lower[q] * y0
            y[k, 1] -= lower[q] * y1
            y[k, 2] -= lower[q] * y2
    for c in range(n - 1, -1, -1):
        y0, y1, y2 = y[c, 0] / diagonal[c], y[c, 1] / diagonal[c], y[c, 2] / diagonal[c]
        for q in range(begin[c], begin[c + 1]):
            k = below[q]
            y0 -= lower[q] * y[k, 0]
            y1 -= lower[q] * y[k, 1]
            y2 -= lower[q] * y[k, 2]
        y[c, 0], y[c, 1], y[c, 2] = y0, y1, y2


@njit(cache=True, fastmath=True)
def _search(x, base, start, other, stiffness, rest, row, begin, below, lower, diagonal, rounds, momentum):
    now, before, ahead = x.copy(), x.copy(), x.copy()
    out = np.empty_like(base)
    for _ in range(rounds):
        for i in range(x.shape[0]):
            if row[i] >= 0:
                for d in range(3):
                    ahead[i, d] = now[i, d] + momentum * (now[i, d] - before[i, d])
                    before[i, d] = now[i, d]
        _turned(ahead, base, start, other, stiffness, rest, row, out)
        _solve(begin, below, lower, diagonal, out)
        for i in range(x.shape[0]):
            if row[i] >= 0:
                for d in range(3):
                    now[i, d] = out[row[i], d]
    return now


def hang(springs: Springs, x: np.ndarray, held: tuple[int, int], rounds: int = ROUNDS) -> np.ndarray:
    """Positions at rest under gravity.

    Args:
        springs: the gown.
        x: (V, 3) where to start; the held vertices stay there [m].
        held: which vertices are held.
        rounds: of the search.

    Returns:
        (V, 3) [m].
    """
    count = len(x)
    one = np.repeat(np.arange(count), np.diff(springs.start))
    degree = np.bincount(one, weights=springs.stiffness, minlength=count)
    pulls = sparse.csr_matrix((springs.stiffness, (one, springs.other)), (count, count))
    matrix = (sparse.diags(degree) - pulls).tocsc()
    free = np.setdiff1d(np.arange(count), held)
    # the matrix is symmetric and diagonally dominant: with diagonal pivots and one order for rows and columns its
    # factors are L and D L^T
    order = np.argsort(splu(matrix[free][:, free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                            options={"SymmetricMode": True}).perm_c)
    free = free[order]
    row = np.full(count, -1)
    row[free] = np.arange(len(free))
    base = -(matrix[free][:, list(held)] @ x[list(held)])
    base[:, 2] -= springs.mass[free] * GRAVITY
    factor = splu(matrix[free][:, free].tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0,
                  options={"SymmetricMode": True})
    lower = sparse.csc_matrix(sparse.tril(factor.L, -1))
    return _search(x, base, springs.start, springs.other, springs.stiffness, springs.rest, row, lower.indptr,
                   lower.indices, lower.data, factor.U.diagonal(), rounds, MOMENTUM)

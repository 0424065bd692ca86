"""Static equilibrium: how a gown rests that is held by two vertices.

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

from ....sim.bullet.soft_world import GRAVITY
from ....sim.compiled import njit
from ....sim.scene.gown import GownMesh
from ....sim.spring.banded_cholesky import factor, solve
from ....sim.spring.mass_spring import Springs, laplacian

NEARER = 0.8  # distance of the two held vertices over their distance at rest
CURL = 1.5  # of the start: curvature of the roll about the vertical [1/m]
ROUNDS = 500
MOMENTUM = 0.98


def held_start(mesh: GownMesh, held: tuple[int, int]) -> np.ndarray:
    """Where the search for the static equilibrium starts: a gown rolled about the vertical that bulges to +y.

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


@njit(fastmath=True)
def _turned(x, base, start, other, stiffness, rest, row, out):
    """Right-hand side of the balance into `out` (3, free): held part and weight, and every spring at rest length."""
    out[:] = base
    for i in range(x.shape[0]):
        a = row[i]
        for q in range(start[i], start[i + 1]):
            j = other[q]
            dx, dy, dz = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
            share = stiffness[q] * rest[q] / np.sqrt(dx * dx + dy * dy + dz * dz)
            if a >= 0:
                out[0, a] += share * dx
                out[1, a] += share * dy
                out[2, a] += share * dz
            b = row[j]
            if b >= 0:
                out[0, b] -= share * dx
                out[1, b] -= share * dy
                out[2, b] -= share * dz


@njit(fastmath=True)
def _search(x, base, start, other, stiffness, rest, row, lower, rounds, momentum):
    now, before, ahead = x.copy(), x.copy(), x.copy()
    out = np.empty_like(base)
    for _ in range(rounds):
        for i in range(x.shape[0]):
            if row[i] >= 0:
                for d in range(3):
                    ahead[i, d] = now[i, d] + momentum * (now[i, d] - before[i, d])
                    before[i, d] = now[i, d]
        _turned(ahead, base, start, other, stiffness, rest, row, out)
        solve(lower, out)
        for i in range(x.shape[0]):
            if row[i] >= 0:
                for d in range(3):
                    now[i, d] = out[d, row[i]]
    return now


def static_equilibrium(springs: Springs, x: np.ndarray, held: tuple[int, int], rounds: int = ROUNDS) -> np.ndarray:
    """Positions at rest under gravity.

    Args:
        springs: the gown.
        x: (V, 3) where to start; the held vertices stay there [m].
        held: which vertices are held.
        rounds: of the search.

    Returns:
        (V, 3) [m].
    """
    free = np.ones(len(x), bool)
    free[list(held)] = False
    pulls = laplacian(springs, springs.stiffness)
    system = factor(pulls, free)
    base = np.ascontiguousarray(-(pulls[system.free][:, list(held)] @ x[list(held)]).T)
    base[2] -= springs.mass[system.free] * GRAVITY
    return _search(
        x,
        base,
        springs.start,
        springs.other,
        springs.stiffness,
        springs.rest,
        system.row,
        system.lower,
        rounds,
        MOMENTUM,
    )

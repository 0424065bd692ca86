"""PyBullet's mass-spring cloth without PyBullet: the same equations in numba, several times faster.

Bullet's deformable solver does this to a cloth with `useMassSpring`, `useBendingSprings` and
`springDampingAllDirections` (and nothing touching it), and so does this file:

    w  = v + dt (g + f(x) / m)                 springs and gravity, explicit
    (M + dt d L) v' = M w                      damping, implicit; L is the graph Laplacian of all springs
    x' = x + dt v'

f sums `k (|e| - rest) e / |e|` over the edges of the mesh (k = elastic) and over all pairs of vertices two edges
apart (k = bending).  Bullet solves the middle line by conjugate residuals, this by conjugate gradients; the clips
agree to a fraction of a millimetre (`tests/learning/physics/engine/test_mass_spring.py`).  What Bullet lacks is added
here: drag of still air at every vertex, with the law of `sim/effects/cloth/air_drag.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

from ..bullet.soft_world import GRAVITY
from ..compiled import njit
from ..scene.gown import GownMesh, edge_counts
from .banded_cholesky import Band, factor, solve


@dataclass(frozen=True, kw_only=True)
class Springs:
    """A gown's springs, each listed once, at the end with the lower number.

    Attributes:
        start: (V + 1,) where each vertex's springs begin in the lists below.
        other: (S,) vertex at the other end.
        stiffness: (S,) [N/m].
        rest: (S,) rest lengths [m].
        mass: (V,) [kg].
        area: (V,) a third of the faces around each vertex [m^2].
        damping: of every spring, in all directions [N s/m].
        air_drag: force per area and squared speed [N s^2/m^4].
    """

    start: np.ndarray
    other: np.ndarray
    stiffness: np.ndarray
    rest: np.ndarray
    mass: np.ndarray
    area: np.ndarray
    damping: float
    air_drag: float


@dataclass(frozen=True, kw_only=True)
class Weave:
    """What of the springs depends on the mesh alone, worth keeping between gowns of one cut.

    Attributes:
        start: (V + 1,) as in `Springs`.
        other: (S,) as in `Springs`.
        rest: (S,) rest lengths [m].
        bends: (S,) bool, a bending spring (two edges apart).
        area: (V,) [m^2].
    """

    start: np.ndarray
    other: np.ndarray
    rest: np.ndarray
    bends: np.ndarray
    area: np.ndarray

    def springs(self, *, mass: float, elastic: float, bending: float, damping: float, air_drag: float = 0.0) -> Springs:
        """The springs of a gown of this cut: [kg], [N/m], [N/m], [N s/m], [N s^2/m^4]."""
        count = len(self.area)
        return Springs(
            start=self.start,
            other=self.other,
            rest=self.rest,
            mass=np.full(count, mass / count),
            stiffness=np.where(self.bends, bending, elastic),
            area=self.area,
            damping=damping,
            air_drag=air_drag,
        )


def weave(mesh: GownMesh) -> Weave:
    """Edges and pairs two edges apart, as Bullet's `generateBendingConstraints(2)` finds them."""
    vertices, count = mesh.vertices, len(mesh.vertices)
    edges = np.array(sorted(edge_counts(mesh.sewn)))
    near: list[set[int]] = [set() for _ in range(count)]
    for a, b in edges.tolist():
        near[a].add(b)
        near[b].add(a)
    apart = sorted({(i, j) for i in range(count) for k in near[i] for j in near[k] if j > i and j not in near[i]})
    pairs = np.vstack([edges, np.array(apart).reshape(-1, 2)])
    bends = np.arange(len(pairs)) >= len(edges)
    length = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
    order = np.argsort(pairs[:, 0], kind="stable")
    one, other = pairs[order].T
    a, b, c = (vertices[mesh.faces[:, k]] for k in range(3))  # the air does not feel the stays
    area = np.bincount(
        mesh.faces.ravel(), minlength=count, weights=np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0, 3)
    )
    return Weave(
        start=np.searchsorted(one, np.arange(count + 1)),
        other=np.ascontiguousarray(other),
        rest=length[order],
        bends=bends[order],
        area=area,
    )


@njit(fastmath=True)
def pull(
    x: np.ndarray, start: np.ndarray, other: np.ndarray, stiffness: np.ndarray, rest: np.ndarray, force: np.ndarray
) -> None:
    """Force of the springs on every vertex [N], into `force` (V, 3)."""
    force[:] = 0.0
    for i in range(x.shape[0]):
        for q in range(start[i], start[i + 1]):
            j = other[q]
            dx, dy, dz = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
            pull = stiffness[q] * (1.0 - rest[q] / np.sqrt(dx * dx + dy * dy + dz * dz))
            force[i, 0] += pull * dx
            force[i, 1] += pull * dy
            force[i, 2] += pull * dz
            force[j, 0] -= pull * dx
            force[j, 1] -= pull * dy
            force[j, 2] -= pull * dz


@njit(fastmath=True)
def _advance(x, v, start, other, stiffness, rest, mass, area, row, lower, drag, gravity, dt, steps):
    """`steps` steps in place."""
    n = x.shape[0]
    force, momentum = np.zeros((n, 3)), np.empty((3, lower.shape[0]))
    for _ in range(steps):
        pull(x, start, other, stiffness, rest, force)
        for i in range(n):
            a = row[i]
            if a < 0:
                continue
            air = drag * area[i] * np.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2)
            for d in range(3):
                momentum[d, a] = mass[i] * v[i, d] + dt * (force[i, d] - air * v[i, d])
            momentum[2, a] -= dt * gravity * mass[i]
        solve(lower, momentum)
        for i in range(n):
            a = row[i]
            if a >= 0:
                for d in range(3):
                    v[i, d] = momentum[d, a]
                    x[i, d] += dt * v[i, d]


def laplacian(springs: Springs, weights: np.ndarray) -> sparse.csr_matrix:
    """(V, V) graph Laplacian of the springs with `weights` (S,) on them, listed as in `Springs`."""
    count = len(springs.mass)
    one = np.repeat(np.arange(count), np.diff(springs.start))
    joined = sparse.csr_matrix((weights, (one, springs.other)), (count, count))
    joined = joined + joined.T
    return (sparse.diags(joined.sum(axis=1).A1) - joined).tocsr()


def damped(springs: Springs, free: np.ndarray, dt: float) -> Band:
    """The left side of a step of `dt` [s], M + dt d L, factored; `free` is (V,) bool, the others are held."""
    damping = laplacian(springs, np.full(len(springs.other), dt * springs.damping))
    return factor(sparse.csr_matrix(sparse.diags(springs.mass) + damping), free)


def advance(
    springs: Springs, x: np.ndarray, v: np.ndarray, free: np.ndarray, dt: float, steps: int, system: Band | None = None
) -> None:
    """Move `x` and `v`, both (V, 3) [m], [m/s], in place by `steps` steps of `dt` [s].

    Args:
        springs: the gown.
        x: positions.
        v: velocities, zero at the held vertices.
        free: (V,) bool; the others stay where they are.
        dt: step [s].
        steps: how many.
        system: what `damped` made of the same gown, vertices and step; made anew when omitted.
    """
    system = system or damped(springs, free, dt)
    _advance(
        x,
        v,
        springs.start,
        springs.other,
        springs.stiffness,
        springs.rest,
        springs.mass,
        springs.area,
        system.row,
        system.lower,
        springs.air_drag,
        GRAVITY,
        dt,
        steps,
    )

"""PyBullet's mass-spring cloth without PyBullet: the same equations in numba, several times faster.

Bullet's deformable solver does this to a cloth with `useMassSpring`, `useBendingSprings` and
`springDampingAllDirections` (and nothing touching it), and so does this file:

    w  = v + dt (g + f(x) / m)                 springs and gravity, explicit
    (M + dt d L) v' = M w                      damping, implicit; L is the graph Laplacian of all springs
    x' = x + dt v'

f sums `k (|e| - rest) e / |e|` over the edges of the mesh (k = elastic) and over all pairs of vertices two edges
apart (k = bending).  Bullet solves the middle line by conjugate residuals, this by conjugate gradients; the clips
agree to a fraction of a millimetre (`tests/learning/physics/test_springs.py`).  What Bullet lacks is added here:
drag of still air at every vertex, with the law of `sim/effects/air_drag.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from ...sim.cloth import GRAVITY
from ...sim.gown import GownMesh, edge_counts

TOLERANCE = 1e-5  # of the implicit damping, relative to the momentum
ROUNDS_MAX = 200  # conjugate gradient rounds a step


@dataclass(frozen=True, kw_only=True)
class Springs:
    """A gown's springs, each listed at both of its ends.

    Attributes:
        start: (V + 1,) where each vertex's springs begin in the lists below.
        other: (2 S,) vertex at the other end.
        stiffness: (2 S,) [N/m].
        rest: (2 S,) rest lengths [m].
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
        other: (2 S,) as in `Springs`.
        rest: (2 S,) rest lengths [m].
        bends: (2 S,) bool, a bending spring (two edges apart).
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
        return Springs(start=self.start, other=self.other, rest=self.rest, mass=np.full(count, mass / count),
                       stiffness=np.where(self.bends, bending, elastic), area=self.area, damping=damping,
                       air_drag=air_drag)


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
    one, other = np.concatenate([pairs, pairs[:, ::-1]]).T
    order = np.argsort(one, kind="stable")
    a, b, c = (vertices[mesh.sewn[:, k]] for k in range(3))
    area = np.bincount(mesh.sewn.ravel(), minlength=count,
                       weights=np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0, 3))
    return Weave(start=np.searchsorted(one[order], np.arange(count + 1)), other=np.ascontiguousarray(other[order]),
                 rest=np.tile(length, 2)[order], bends=np.tile(bends, 2)[order], area=area)


@numba.njit(cache=True, fastmath=True)
def _pull(x, start, other, stiffness, rest, force):
    """Force of the springs on every vertex [N], into `force` (V, 3)."""
    force[:] = 0.0
    for i in range(x.shape[0]):
        for q in range(start[i], start[i + 1]):
            j = other[q]
            if j < i:  # each spring once
                continue
            dx, dy, dz = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
            pull = stiffness[q] * (1.0 - rest[q] / np.sqrt(dx * dx + dy * dy + dz * dz))
            force[i, 0] += pull * dx
            force[i, 1] += pull * dy
            force[i, 2] += pull * dz
            force[j, 0] -= pull * dx
            force[j, 1] -= pull * dy
            force[j, 2] -= pull * dz


@numba.njit(cache=True, fastmath=True)
def _damp(p, start, other, mass, free, coupling, image):
    """(M + coupling L) p into `image`; returns p . image.  Held vertices have p = 0."""
    product = 0.0
    for i in range(p.shape[0]):
        if not free[i]:
            continue
        sx = sy = sz = 0.0
        for q in range(start[i], start[i + 1]):
            j = other[q]
            sx += p[j, 0]
            sy += p[j, 1]
            sz += p[j, 2]
        own = mass[i] + coupling * (start[i + 1] - start[i])
        image[i, 0] = own * p[i, 0] - coupling * sx
        image[i, 1] = own * p[i, 1] - coupling * sy
        image[i, 2] = own * p[i, 2] - coupling * sz
        product += p[i, 0] * image[i, 0] + p[i, 1] * image[i, 1] + p[i, 2] * image[i, 2]
    return product


@numba.njit(cache=True, fastmath=True)
def _advance(x, v, start, other, stiffness, rest, mass, area, free, damping, drag, gravity, dt, steps, tolerance):
    """`steps` steps in place; returns the conjugate gradient rounds they took."""
    n = x.shape[0]
    w, r, p, image = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    coupling = dt * damping
    rounds = 0
    for step in range(steps):
        _pull(x, start, other, stiffness, rest, image)
        scale = 0.0
        for i in range(n):
            if not free[i]:
                continue
            push = dt / mass[i]
            air = drag * area[i] * np.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2)
            for d in range(3):
                before = v[i, d]
                last = before - w[i, d] if step > 0 else 0.0  # what damping changed in the last step: a good guess
                w[i, d] = before + push * (image[i, d] - air * before) - (dt * gravity if d == 2 else 0.0)
                v[i, d] = w[i, d] + last
                scale += (mass[i] * w[i, d]) ** 2
        _damp(v, start, other, mass, free, coupling, image)
        left = 0.0
        for i in range(n):
            if free[i]:
                for d in range(3):
                    r[i, d] = mass[i] * w[i, d] - image[i, d]
                    p[i, d] = r[i, d]
                    left += r[i, d] ** 2
        k = 0
        while left > tolerance * tolerance * scale and k < ROUNDS_MAX:
            share, before_left = left / _damp(p, start, other, mass, free, coupling, image), left
            left = 0.0
            for i in range(n):
                if free[i]:
                    for d in range(3):
                        v[i, d] += share * p[i, d]
                        r[i, d] -= share * image[i, d]
                        left += r[i, d] ** 2
            turn = left / before_left
            for i in range(n):
                if free[i]:
                    for d in range(3):
                        p[i, d] = r[i, d] + turn * p[i, d]
            k += 1
        rounds += k
        for i in range(n):
            if free[i]:
                for d in range(3):
                    x[i, d] += dt * v[i, d]
    return rounds


def advance(springs: Springs, x: np.ndarray, v: np.ndarray, free: np.ndarray, dt: float, steps: int,
            tolerance: float = TOLERANCE) -> int:
    """Move `x` and `v`, both (V, 3) [m], [m/s], in place by `steps` steps of `dt` [s].

    Args:
        springs: the gown.
        x: positions.
        v: velocities, zero at the held vertices.
        free: (V,) bool; the others stay where they are.
        dt: step [s].
        steps: how many.
        tolerance: of the implicit damping.

    Returns:
        Rounds of conjugate gradients, the measure of what it cost.
    """
    return _advance(x, v, springs.start, springs.other, springs.stiffness, springs.rest, springs.mass, springs.area,
                    free, springs.damping, springs.air_drag, GRAVITY, dt, steps, tolerance)

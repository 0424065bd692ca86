"""One cloth of springs that lies, hangs, slides and is held: its state and its step.

    w  = v + dt (g + f(x) / m)                 springs, air and gravity, explicit
    (M + dt d L) v' = M w                      damping, implicit (`mass_spring.py`, `banded_cholesky.py`)
    v' so that nothing closes and nothing is stretched too far (`touching.py`)
    x' = x + dt v'

Held vertices go where they are taken; what pulls on them is kept account of.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sparse

from ..bullet.soft_world import GRAVITY, MARGIN
from ..compiled import njit
from ..scene.gown import GownMesh, edge_counts
from .banded_cholesky import Band, factor, solve
from .layers import Layers
from .mass_spring import laplacian, pull, weave
from .solids import Solids
from .touching import meet, near_pairs

ROUNDS = 3  # of impulses in a step
LONGEST = 1.6  # of an edge, in rest lengths
REACH = 0.03  # pairs this near are looked at ... [m]
LOOK = 4  # ... for so many steps: cloth and solids approach each other by 3 m/s at most
FELT = 0.01  # the load on held vertices follows in this time [s]


class Sheet:
    """A cloth at one instant.

    Args:
        mesh: rest shape; its spec holds mass, stiffness, damping and friction.
        vertices: (V, 3) where it starts, at rest [m].
        dt: step [s].
        meets_itself: whether its folds keep apart.

    Attributes:
        x: (V, 3) positions [m].
        v: (V, 3) velocities [m/s].
        held: vertices that are held.
        load: (V, 3) force of the cloth on whatever holds a vertex [N]; of free vertices nothing is meant.
    """

    def __init__(self, mesh: GownMesh, vertices: np.ndarray, dt: float, meets_itself: bool = False) -> None:
        spec = mesh.spec
        self.mesh, self.dt, self.friction = mesh, dt, spec.friction
        self.springs = weave(mesh).springs(
            mass=spec.mass, elastic=spec.elastic, bending=spec.bending, damping=spec.damping, air_drag=spec.air_drag
        )
        edges = np.array(sorted(edge_counts(mesh.sewn)))
        self._edges = np.ascontiguousarray(edges.T)
        lengths = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
        self._longest, self._pulls = LONGEST * lengths, np.zeros(len(edges))
        seen = np.array(sorted(edge_counts(mesh.faces)))  # stays are within the cloth, no part of its surface
        each = np.arange(len(mesh.vertices))
        self._points = np.ascontiguousarray(np.vstack([np.column_stack([each, each]), seen]).T)
        self._damping = sparse.csr_matrix(
            sparse.diags(self.springs.mass)
            + laplacian(self.springs, np.full(len(self.springs.other), dt * spec.damping))
        )
        self._one = np.repeat(each, np.diff(self.springs.start))
        self.gravity = np.array((0.0, 0.0, -GRAVITY))
        self._layers = Layers(mesh.vertices, mesh.faces) if meets_itself else None
        self.held: set[int] = set()
        self.place(vertices)
        self._hold()

    def place(self, vertices: np.ndarray) -> None:
        """Put every vertex (V, 3) somewhere else [m], at rest."""
        self.x = np.array(vertices, float)
        self.v = np.zeros_like(self.x)
        self.load = np.zeros_like(self.x)
        self._pulls[:] = 0.0
        self._looked = 0

    def hold(self, ids: Iterable[int]) -> None:
        """Hold vertices where they are."""
        ids = [int(k) for k in ids]
        self.held.update(ids)
        self.v[ids], self.load[ids] = 0.0, 0.0
        self._hold()

    def release(self, ids: Iterable[int]) -> None:
        """Let vertices go, as fast as they were moved."""
        self.held.difference_update(ids)
        self._hold()

    def _hold(self) -> None:
        """Make the system anew for who is held now."""
        free = np.ones(len(self.x), bool)
        free[list(self.held)] = False
        self._band: Band = factor(self._damping, free)
        self._loose = np.where(free, 1.0 / self.springs.mass, 0.0)
        one, other = self._one, self.springs.other
        out, back = free[one] & ~free[other], ~free[one] & free[other]
        # springs from a free vertex to a held one
        self._rim = np.ascontiguousarray(np.vstack([np.r_[one[out], other[back]], np.r_[other[out], one[back]]]))

    def take(self, ids: np.ndarray, places: np.ndarray) -> None:
        """Have held vertices `ids` (n,) at `places` (n, 3) at the end of the next step [m]."""
        self.v[ids] = (places - self.x[ids]) / self.dt

    def step(self, solids: Solids, given: np.ndarray) -> None:
        """Pass one step.

        Args:
            solids: what the cloth meets.
            given: (n, 7) what cloth gives to each of them (`touching._share_out`); this cloth's is added.
        """
        if self._looked % LOOK == 0 or solids.changed:
            self._pairs = self._near(solids)
            if self._layers is not None:
                self._layers.look(self.x, REACH / 2)
        self._looked += 1
        force = self.free_step()
        if self._layers is not None:
            self._layers.part(self.x, self.v, self._loose, self.dt, ROUNDS)
        impulses = meet(
            *(self.x, self.v, self._loose, *self._points, self._pairs, solids.capsules, solids.speeds, solids.radii),
            *(solids.boxes, solids.box_speeds, self.friction * solids.friction, MARGIN, self.dt),
            *(*self._edges, self._longest, self._pulls, ROUNDS, given),
        )
        _move(self.x, self.v, force, impulses, self.load, self.dt)

    def free_step(self) -> np.ndarray:
        """Give the cloth the velocities that springs, air, gravity and damping make; returns their force (V, 3) [N]."""
        s, force = self.springs, np.empty_like(self.x)
        _free_step(
            *(self.x, self.v, s.start, s.other, s.stiffness, s.rest, s.mass, s.area, self._band.row, self._band.lower),
            *(self._rim, s.damping, s.air_drag, self.gravity, self.dt, force),
        )
        return force

    def keep_apart(self, anew: bool) -> None:
        """Change the velocities so that no fold passes through another in the next step, where the cloth meets itself.

        Args:
            anew: whether to look for folds that are near each other; the ones found last are kept otherwise.
        """
        if self._layers is not None:
            if anew:
                self._layers.look(self.x, REACH / 2)
            self._layers.part(self.x, self.v, self._loose, self.dt, ROUNDS)

    def forget_layers(self) -> None:
        """Take every vertex to be on the side of each fold on which it is seen next."""
        if self._layers is not None:
            self._layers.forget()

    def move_on(self) -> None:
        """Go where the velocities lead in one step."""
        self.x += self.dt * self.v

    @property
    def loose(self) -> np.ndarray:
        """(V,) one over the mass of each vertex, 0 of those that are held [1/kg]."""
        return self._loose

    def _near(self, solids: Solids) -> np.ndarray:
        one, other = self._points
        out = np.empty((len(one) * (len(solids.radii) + len(solids.boxes)), 2), np.int64)
        count = near_pairs(self.x, one, other, solids.capsules, solids.radii, solids.boxes, MARGIN + REACH, out)
        return out[:count].copy()

    def energy(self) -> float:
        """Of motion, springs and height above the map's origin [J]."""
        s = self.springs
        length = np.linalg.norm(self.x[self._one] - self.x[s.other], axis=1)
        moving = 0.5 * (s.mass[:, None] * self.v**2).sum()
        return float(moving + 0.5 * (s.stiffness * (length - s.rest) ** 2).sum() - (s.mass @ self.x) @ self.gravity)


@njit(fastmath=True)
def _free_step(x, v, start, other, stiffness, rest, mass, area, row, lower, rim, damping, drag, gravity, dt, force):
    """Springs, air, gravity and damping; `force` (V, 3) becomes that of springs and weight."""
    n = len(x)
    pull(x, start, other, stiffness, rest, force)
    momentum = np.empty((3, len(lower)))
    for i in range(n):
        a = row[i]
        air = drag * area[i] * np.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2)
        for d in range(3):
            force[i, d] += mass[i] * gravity[d]
            if a >= 0:
                momentum[d, a] = mass[i] * v[i, d] + dt * (force[i, d] - air * v[i, d])
    for e in range(rim.shape[1]):
        for d in range(3):
            momentum[d, row[rim[0, e]]] += dt * damping * v[rim[1, e], d]
    solve(lower, momentum)
    for i in range(n):
        if row[i] >= 0:
            for d in range(3):
                v[i, d] = momentum[d, row[i]]
    for e in range(rim.shape[1]):
        for d in range(3):
            force[rim[1, e], d] += damping * (v[rim[0, e], d] - v[rim[1, e], d])


@njit(fastmath=True)
def _move(x, v, force, impulses, load, dt):
    """The end of a step: places, and what pulls on whatever holds a vertex."""
    for i in range(len(x)):
        for d in range(3):
            load[i, d] += dt / FELT * (force[i, d] + impulses[i, d] / dt - load[i, d])
            x[i, d] += dt * v[i, d]

"""Forces on PyBullet cloth through small rigid proxy bodies anchored to vertices spread over it.

A world loads its soft body with `ClothPatch.settings` and `ClothPatch.cloth_mass`, then hands the body to
`ClothPatch.attach` and calls `ClothPatch.apply` before every step.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..model_file import EffectEntry
from .added_mass import AddedMass
from .cloth_effect import ClothSettings, ProxyState
from .cloth_registry import CLOTH_EFFECTS
from .snag import Snag

PROXY_MASS = 5e-4  # [kg]; lighter ones do not pass a force on to the cloth
RADIUS = 0.004  # [m] of the sphere, which collides with nothing


def proxy_count(vertices: int) -> int:
    """How many proxy bodies a cloth of so many vertices gets."""
    return int(np.clip(vertices // 12, 12, 60))


def spread_vertices(vertices: np.ndarray, count: int, avoid: set[int]) -> np.ndarray:
    """Vertices far from each other (farthest point sampling), never one of `avoid`, (count,).

    Grids are full of equal distances; rounding lets the lower number win, so that a mesh moved, turned or read from a
    file gets the same ones.
    """
    free = np.array([i for i in range(len(vertices)) if i not in avoid])
    points = vertices[free]
    first = int(np.argmin(np.round(np.linalg.norm(points - points.mean(axis=0), axis=1), 5)))
    chosen, away = [first], np.linalg.norm(points - points[first], axis=1)
    while len(chosen) < min(count, len(free)):
        k = int(np.argmax(np.round(away, 5)))
        chosen.append(k)
        away = np.minimum(away, np.linalg.norm(points - points[k], axis=1))
    return free[chosen]


class ClothPatch:
    """The effects of a model on one cloth.

    Attributes:
        settings: friction and gravity the soft body must be loaded with.
        cloth_mass: mass it must be loaded with, the proxy bodies' taken off [kg].
        release_t: when the first pin lets go [s], or None.
    """

    def __init__(
        self,
        effects: tuple[EffectEntry, ...],
        vertices: np.ndarray,
        faces: np.ndarray,
        mass: float,
        settings: ClothSettings,
        pinned: set[int] | None = None,
        capsules: np.ndarray | None = None,
        per_second: float = 1.0,
    ) -> None:
        """Prepare the effects for a cloth in its start pose.

        Args:
            effects: checked entries of a cloth model file.
            vertices: (V, 3) start pose [m].
            faces: (F, 3).
            mass: of the whole cloth [kg].
            settings: as the world would load it.
            pinned: vertices that are held; they get no proxy body.
            capsules: (K, 7) bodies cloth may cling to.
            per_second: the world's units of time in a second; forces and velocities are converted.
        """
        self._per_second = per_second
        self.effects = [(CLOTH_EFFECTS[e.name], e.parameters) for e in effects]
        for effect, values in self.effects:
            settings = effect.settings(settings, values)
            if isinstance(effect, Snag):
                effect.restart()
        self.settings = settings
        released = [effect.release(values) for effect, values in self.effects]
        self.release_t = min((r for r in released if r is not None), default=None)
        self._on_proxies = [(e, v) for e, v in self.effects if e.needs_proxies]
        self._capsules = np.zeros((0, 7)) if capsules is None else np.asarray(capsules, dtype=float)
        self._bodies: list[int] = []
        self._anchors: list[int] = []
        self.vertices = np.zeros(0, dtype=int)
        if self._on_proxies:
            self.vertices = spread_vertices(vertices, proxy_count(len(vertices)), pinned or set())
            self._lay_out(vertices, faces, mass)
        self.cloth_mass = mass - PROXY_MASS * len(self.vertices)

    def _lay_out(self, vertices: np.ndarray, faces: np.ndarray, mass: float) -> None:
        self._start = vertices[self.vertices]
        nearest = np.argmin(np.linalg.norm(vertices[:, None] - self._start[None], axis=2), axis=1)
        edges = vertices[faces]
        size = 0.5 * np.linalg.norm(np.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]), axis=1)
        per_vertex = np.zeros(len(vertices))
        np.add.at(per_vertex, faces.ravel(), np.repeat(size / 3.0, 3))
        self._area = np.bincount(nearest, weights=per_vertex, minlength=len(self._start))
        self._mass = mass * self._area / max(self._area.sum(), 1e-12)
        touching = nearest[np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])]
        pairs = np.unique(np.sort(touching[touching[:, 0] != touching[:, 1]], axis=1), axis=0)
        self._pairs = pairs
        self._lengths = np.linalg.norm(self._start[pairs[:, 0]] - self._start[pairs[:, 1]], axis=1)
        shares = (e.share(self._start, v) for e, v in self._on_proxies if isinstance(e, AddedMass))
        self._extra = sum(shares, np.zeros(len(self._start)))

    def attach(self, client: Any, cloth: int, places: np.ndarray | None = None) -> None:
        """Create the proxy bodies and anchor them; added mass is mass of the proxy bodies, so it has inertia too.

        Args:
            client: pybullet client the cloth lives in.
            cloth: its body id.
            places: (V, 3) where the vertices are now, if not in the start pose [m].
        """
        self._client = client
        if not len(self.vertices):
            return
        where = self._start if places is None else places[self.vertices]
        shape = client.createCollisionShape(client.GEOM_SPHERE, radius=RADIUS)
        for k, (vertex, place) in enumerate(zip(self.vertices, where, strict=True)):
            body = client.createMultiBody(PROXY_MASS + float(self._extra[k]), shape, basePosition=place.tolist())
            client.setCollisionFilterGroupMask(body, -1, 0, 0)
            client.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0)
            self._anchors.append(client.createSoftBodyAnchor(cloth, int(vertex), body, -1))
            self._bodies.append(body)

    def detach(self) -> None:
        """Remove the proxy bodies, for instance before the cloth is put somewhere else."""
        for anchor, body in zip(self._anchors, self._bodies, strict=True):
            self._client.removeConstraint(anchor)
            self._client.removeBody(body)
        self._anchors, self._bodies = [], []

    def apply(self, t: float) -> None:
        """Apply the forces of one step at time `t` [s]."""
        pushing = [(e, v) for e, v in self._on_proxies if not isinstance(e, AddedMass)]
        if not pushing or not self._bodies:
            return
        p = self._client
        x = np.array([p.getBasePositionAndOrientation(b)[0] for b in self._bodies])
        v = np.array([p.getBaseVelocity(b)[0] for b in self._bodies]) * self._per_second
        state = ProxyState(
            t=t,
            x=x,
            v=v,
            start=self._start,
            mass=self._mass,
            area=self._area,
            pairs=self._pairs,
            lengths=self._lengths,
            capsules=self._capsules,
            gravity=np.array(self.settings.gravity),
        )
        total = np.zeros_like(x)
        for effect, values in pushing:
            total += effect.forces(state, values)
        total /= self._per_second**2
        for body, force, place in zip(self._bodies, total, x, strict=True):
            p.applyExternalForce(body, -1, force.tolist(), place.tolist(), p.WORLD_FRAME)

"""The gown as a PyBullet soft body: mass-spring cloth that can be pinned at vertices."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..compiled import njit
from ..effects.cloth.gown_patch import gown_patch, loaded, recalibrated
from ..effects.cloth.proxy_bodies import ClothPatch
from ..effects.model_file import EffectModel
from ..errors import CaretreeError
from ..scene.gown import GownMesh, edge_counts
from .soft_world import GRAVITY, STABILITY_MAX, SoftWorld


class UnstableClothError(CaretreeError):
    """A gown too stiff or too light for the time step."""


def refuse_unstable(mesh: GownMesh, time_step: float) -> None:
    """Refuse springs that an explicit step of `time_step` [s] would make explode.

    Raises:
        UnstableClothError: the cloth is too stiff or too light.
    """
    spec = mesh.spec
    stiffness = spec.elastic * time_step**2 / (spec.mass / len(mesh.vertices))
    if stiffness > STABILITY_MAX:
        raise UnstableClothError(
            f"cloth '{spec.name}': elastic x dt^2 / vertex mass is {stiffness:.2f}, at most "
            f"{STABILITY_MAX} is stable: lower the stiffness or the time step"
        )


class ClothBody(ABC):
    """A cloth in a room: what hands, hooks and the world ask of it, whichever engine moves it.

    Attributes:
        mesh: rest shape.
        body: its number in the room, negative once it was removed.
    """

    mesh: GownMesh
    body: int

    @abstractmethod
    def place(self, vertices: np.ndarray) -> None:
        """Put every vertex (V, 3) somewhere else [m], at rest."""

    @abstractmethod
    def vertices(self) -> np.ndarray:
        """(V, 3) positions in the map frame [m]; none of a cloth that was removed."""

    @abstractmethod
    def remove(self) -> None:
        """Take it out of the room."""

    @abstractmethod
    def pin(self, ids: Iterable[int], body: int = -1, link: int = -1) -> list[int]:
        """Hold vertices to a link, or to the world, where they are now; returns the constraints."""

    @abstractmethod
    def unpin(self, constraints: Iterable[int]) -> None:
        """Let pinned vertices go."""

    @abstractmethod
    def load(self, held: Collection[int], vertices: np.ndarray) -> np.ndarray:
        """(3,) force that the cloth, whose vertices are given, exerts on whatever holds the vertices `held` [N]."""


@dataclass(frozen=True, kw_only=True)
class _Cut:
    """The n springs that hold some vertices: their held ends, their free ends (n,) int, rest lengths (n,) [m]."""

    inner: np.ndarray
    outer: np.ndarray
    rest: np.ndarray


class Cloth(ClothBody):
    """One gown, or another cloth, in a soft world.

    Args:
        world: where it moves.
        mesh: rest shape; its spec holds mass and stiffness.
        vertices: (V, 3) where it starts, at rest, map frame [m].
        options: of PyBullet's `loadSoftBody`, to try what they change.

    Raises:
        UnstableClothError: the springs would be unstable at the world's time step.
    """

    def __init__(
        self, world: SoftWorld, mesh: GownMesh, vertices: np.ndarray, options: Mapping[str, Any] | None = None
    ) -> None:
        refuse_unstable(mesh, world.time_step)
        self.world, self.mesh, spec = world, mesh, mesh.spec
        self.body = world.load_cloth(
            mesh.vertices,
            mesh.sewn,
            mass=spec.mass,
            elastic=spec.elastic,
            damping=spec.damping,
            bending=spec.bending,
            friction=spec.friction,
            options=options,
        )
        self.edges = np.array(list(edge_counts(mesh.sewn)))
        self._cuts: dict[tuple[int, ...], _Cut] = {}
        self.rest_lengths = np.linalg.norm(mesh.vertices[self.edges[:, 0]] - mesh.vertices[self.edges[:, 1]], axis=1)
        self.place(vertices)

    def place(self, vertices: np.ndarray) -> None:
        """Put every vertex (V, 3) somewhere else [m], at rest."""
        client = self.world.client
        client.resetMeshData(self.body, np.asarray(vertices, float).tolist())
        # without the angular part only the mean velocity would go
        client.resetBaseVelocity(self.body, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])

    def vertices(self) -> np.ndarray:
        """(V, 3) positions in the map frame [m]; none of a cloth that was removed."""
        return self.world.vertices(self.body) if self.body >= 0 else np.zeros((0, 3))

    def remove(self) -> None:
        """Take it out of the world."""
        self.world.client.removeBody(self.body)
        self.body = -1

    def pin(self, ids: Iterable[int], body: int = -1, link: int = -1) -> list[int]:
        """Hold vertices to a link, or to the world, where they are now; returns the constraints."""
        return self.world.anchor(self.body, ids, body, link)

    def unpin(self, constraints: Iterable[int]) -> None:
        """Let pinned vertices go."""
        self.world.release(constraints)

    def load(self, held: Collection[int], vertices: np.ndarray) -> np.ndarray:
        """(3,) force that the cloth exerts on whatever holds the vertices `held` [N].

        The springs between held and free vertices are the cut through which all of the load passes; add the
        held vertices' own weight.  Motor forces behind an anchored link are no load cell as soon as that link
        can turn: known weights were read 8 to 30 % wrong (`tests/sim/bullet/test_handle.py` checks this one).
        """
        cut, load = self._cut(tuple(held)), np.zeros(3)
        _add_pulls(vertices, cut.inner, cut.outer, cut.rest, self.mesh.spec.elastic, load)
        load[2] -= self.mesh.spec.mass * len(held) / len(vertices) * GRAVITY
        return load

    def _cut(self, held: tuple[int, ...]) -> _Cut:
        """The springs between held and free vertices, kept while the same are held: every control step asks."""
        if held not in self._cuts:
            if len(self._cuts) > 20:
                self._cuts.clear()
            mine = np.zeros(len(self.mesh.vertices), dtype=bool)
            mine[list(held)] = True
            cut = mine[self.edges[:, 0]] != mine[self.edges[:, 1]]
            inner, outer = self.edges[cut].T
            swap = mine[outer]
            self._cuts[held] = _Cut(
                inner=np.where(swap, outer, inner), outer=np.where(swap, inner, outer), rest=self.rest_lengths[cut]
            )
        return self._cuts[held]


@njit()
def _add_pulls(
    vertices: np.ndarray, inner: np.ndarray, outer: np.ndarray, rest: np.ndarray, elastic: float, load: np.ndarray
) -> None:
    """Add up in `load` (3,) [N] what springs (n,) of a stiffness [N/m] pull their inner ends with."""
    for n in range(len(rest)):
        a, b = vertices[inner[n]], vertices[outer[n]]
        x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        length = math.sqrt(x * x + y * y + z * z)
        share = elastic * (length - rest[n]) / length
        load[0] += x * share
        load[1] += y * share
        load[2] += z * share


def load_gown(
    world: SoftWorld,
    mesh: GownMesh,
    start: np.ndarray,
    effects: EffectModel | None = None,
    pinned: Collection[int] = (),
    capsules: np.ndarray | None = None,
) -> tuple[Cloth, ClothPatch | None]:
    """A gown with the effects of a model file; gravity becomes what they make of it.

    Args:
        world: where it moves.
        mesh: rest shape; its spec holds mass and stiffness.
        start: (V, 3) where it starts, at rest, map frame [m].
        effects: checked model file, or None.
        pinned: vertices that are held at the start.
        capsules: (K, 7) bodies that cloth may cling to: a, b, radius [m].

    Raises:
        CaretreeError: the gown is lighter than the proxy bodies that its effects act on.
        UnstableClothError: the springs would be unstable at the world's time step.
    """
    if effects is None:
        return Cloth(world, mesh, start), None
    mesh = recalibrated(mesh, effects)
    patch = gown_patch(effects, mesh, start, GRAVITY, set(pinned), capsules, world.unit.per_second)
    world.set_gravity(patch.settings.gravity)
    cloth = Cloth(world, loaded(mesh, patch), start)
    patch.attach(world.client, cloth.body)
    return cloth, patch

"""The gown as a PyBullet soft body: mass-spring cloth that can be pinned at vertices."""

from __future__ import annotations

import tempfile
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaretreeError
from ..scene.gown import GownMesh, edge_counts
from . import units

STABILITY_MAX = 0.7  # elastic * dt^2 / vertex mass: above it the explicit springs explode (measured, FACTS)
MARGIN = 0.006  # collision margin [m]
GRAVITY = 9.81  # [m/s^2]


class UnstableClothError(CaretreeError, ValueError):
    """A gown too stiff or too light for the time step."""


class Cloth:
    """One gown in a deformable world.

    Args:
        client: BulletClient reset with RESET_USE_DEFORMABLE_WORLD, in the units of `units`.
        mesh: rest shape; its spec holds mass and stiffness.
        vertices: (V, 3) where it starts, at rest, map frame [m].
        time_step: of the physics [s].

    Raises:
        UnstableClothError: the springs would be unstable at this time step.
    """

    def __init__(self, client: Any, mesh: GownMesh, vertices: np.ndarray, time_step: float) -> None:
        spec = mesh.spec
        stiffness = spec.elastic * time_step**2 / (spec.mass / len(mesh.vertices))
        if stiffness > STABILITY_MAX:
            raise UnstableClothError(
                f"gown '{spec.name}': elastic x dt^2 / vertex mass is {stiffness:.2f}, at most "
                f"{STABILITY_MAX} is stable: lower the stiffness or the time step"
            )
        self.client, self.mesh = client, mesh
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "gown.obj"
            path.write_text(
                "".join("v {:.9f} {:.9f} {:.9f}\n".format(*v) for v in mesh.vertices)
                + "".join("f {} {} {}\n".format(*(face + 1)) for face in mesh.sewn)
            )
            self.body: int = client.loadSoftBody(
                str(path),
                mass=spec.mass,
                useMassSpring=1,
                useBendingSprings=1,
                useNeoHookean=0,
                springElasticStiffness=units.force(spec.elastic),
                springDampingStiffness=units.rate(spec.damping),
                springDampingAllDirections=1,
                springBendingStiffness=units.force(spec.bending),
                useSelfCollision=0,
                frictionCoeff=spec.friction,
                collisionMargin=MARGIN,
            )
        client.changeDynamics(self.body, -1, activationState=client.ACTIVATION_STATE_DISABLE_SLEEPING)
        self.edges = np.array(list(edge_counts(mesh.sewn)))
        self.rest_lengths = np.linalg.norm(mesh.vertices[self.edges[:, 0]] - mesh.vertices[self.edges[:, 1]], axis=1)
        self.place(vertices)

    def place(self, vertices: np.ndarray) -> None:
        """Put every vertex (V, 3) somewhere else [m], at rest."""
        self.client.resetMeshData(self.body, np.asarray(vertices, float).tolist())
        # without the angular part only the mean velocity would go
        self.client.resetBaseVelocity(self.body, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])

    def vertices(self) -> np.ndarray:
        """(V, 3) positions in the map frame [m]."""
        _, data = self.client.getMeshData(self.body, -1, flags=self.client.MESH_DATA_SIMULATION_MESH)
        return np.array(data)

    def pin(self, ids: Iterable[int], body: int, link: int) -> list[int]:
        """Hold vertices to a link where they are now; returns the constraints."""
        return [self.client.createSoftBodyAnchor(self.body, int(k), body, link) for k in ids]

    def unpin(self, constraints: Iterable[int]) -> None:
        """Let pinned vertices go."""
        for constraint in constraints:
            self.client.removeConstraint(constraint)

    def load(self, held: Collection[int], vertices: np.ndarray) -> np.ndarray:
        """(3,) force that the cloth exerts on whatever holds the vertices `held` [N].

        The springs between held and free vertices are the cut through which all of the load passes; add the
        held vertices' own weight.  Motor forces behind an anchored link are no load cell as soon as that link
        can turn: known weights were read 8 to 30 % wrong (`tests/sim/test_handle.py` checks this one).
        """
        mine = np.zeros(len(vertices), dtype=bool)
        mine[list(held)] = True
        cut = mine[self.edges[:, 0]] != mine[self.edges[:, 1]]
        inner, outer = self.edges[cut].T
        swap = mine[outer]
        inner, outer = np.where(swap, outer, inner), np.where(swap, inner, outer)
        along = vertices[outer] - vertices[inner]
        length = np.linalg.norm(along, axis=1)
        tension = self.mesh.spec.elastic * (length - self.rest_lengths[cut])
        weight = self.mesh.spec.mass * len(held) / len(vertices) * GRAVITY
        return (along * (tension / length)[:, None]).sum(axis=0) - (0.0, 0.0, weight)

    def stretch(self, vertices: np.ndarray) -> np.ndarray:
        """(E,) edge length over rest length."""
        return np.linalg.norm(vertices[self.edges[:, 0]] - vertices[self.edges[:, 1]], axis=1) / self.rest_lengths

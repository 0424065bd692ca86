"""A room whose cloth is made of springs: PyBullet moves what is rigid, `sheet.py` the cloth; they meet at each step.

Stands in for `SoftWorld` and `Cloth` of `sim/bullet`.  Rigid bodies make their step first, under what the cloth did to
them at the last one; then the cloth makes its own among where they have come to.  What holds cloth takes the held
vertices along and does not feel them: the load is measured and told (`SpringCloth.load`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import numpy as np

from ..bullet.cloth import ClothBody, refuse_unstable
from ..bullet.soft_world import GRAVITY
from ..bullet.units import ROOM
from ..scene.gown import GownMesh
from .sheet import Sheet
from .solids import Solids, matrix


class SpringRoom:
    """A rigid PyBullet client and cloths of springs, empty at first.

    Args:
        time_step: of the physics [s].

    Attributes:
        client: the BulletClient; it speaks in the room's unit of time.
        time_step: of the physics [s].
        unit: converts between SI and the client's unit of time.
        cloths: that are in the room.
    """

    def __init__(self, time_step: float) -> None:
        from ..bullet_client import direct_client  # pybullet is loaded only where something is simulated

        self.client: Any = direct_client()
        self.time_step, self.unit = time_step, ROOM
        self.client.setGravity(0.0, 0.0, -ROOM.force(GRAVITY))
        self.client.setPhysicsEngineParameter(solverResidualThreshold=ROOM.residual)
        self.client.setTimeStep(ROOM.time(time_step))
        self.cloths: list[SpringCloth] = []
        self._solids: Solids | None = None

    def step(self) -> None:
        """Pass one time step."""
        self.client.stepSimulation()
        if not self.cloths:
            return
        if self._solids is None:
            self._solids = Solids(self.client, ROOM.per_second)
        self._solids.read(self.time_step)
        given = np.zeros((len(self._solids.friction), 7))
        for cloth in self.cloths:
            cloth.follow()
            cloth.sheet.step(self._solids, given)
        self._solids.push(given, self.time_step)

    def close(self) -> None:
        """End the client."""
        self.client.disconnect()


class SpringCloth(ClothBody):
    """One gown, or another cloth, in a room of springs.

    Args:
        room: where it moves.
        mesh: rest shape; its spec holds mass and stiffness.
        vertices: (V, 3) where it starts, at rest, map frame [m].

    Raises:
        UnstableClothError: the springs would be unstable at the room's time step.
    """

    def __init__(self, room: SpringRoom, mesh: GownMesh, vertices: np.ndarray) -> None:
        refuse_unstable(mesh, room.time_step)
        self.room, self.mesh = room, mesh
        self.body = len(room.cloths)
        self.sheet = Sheet(mesh, vertices, room.time_step)
        self._pins: dict[int, tuple[int, int, int, np.ndarray]] = {}  # pin -> vertex, body, link, place there
        self._pinned = 0
        room.cloths.append(self)

    def place(self, vertices: np.ndarray) -> None:
        """Put every vertex (V, 3) somewhere else [m], at rest."""
        self.sheet.place(vertices)

    def vertices(self) -> np.ndarray:
        """(V, 3) positions in the map frame [m]; none of a cloth that was removed."""
        return self.sheet.x.copy() if self.body >= 0 else np.zeros((0, 3))

    def remove(self) -> None:
        """Take it out of the room."""
        self.room.cloths.remove(self)
        self.body = -1

    def pin(self, ids: Iterable[int], body: int = -1, link: int = -1) -> list[int]:
        """Hold vertices to a link, or to the world, where they are now; returns the pins."""
        ids, first = [int(k) for k in ids], self._pinned
        origin, turn = self._pose(body, link)
        for k in ids:
            self._pins[self._pinned] = (k, body, link, (self.sheet.x[k] - origin) @ turn)
            self._pinned += 1
        self.sheet.hold(ids)
        return list(range(first, self._pinned))

    def unpin(self, constraints: Iterable[int]) -> None:
        """Let pinned vertices go, but for those that something else holds too."""
        gone = [self._pins.pop(pin)[0] for pin in constraints]
        still = {vertex for vertex, *_ in self._pins.values()}
        self.sheet.release(vertex for vertex in gone if vertex not in still)

    def load(self, held: Collection[int], vertices: np.ndarray) -> np.ndarray:
        """(3,) force that the cloth exerts on whatever holds the vertices `held` [N], of the last 10 ms."""
        return self.sheet.load[list(held)].sum(axis=0)

    def follow(self) -> None:
        """Take held vertices along with what holds them."""
        if not self._pins:
            return
        poses: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}
        places: dict[int, np.ndarray] = {}
        for vertex, body, link, local in self._pins.values():
            if (body, link) not in poses:
                poses[body, link] = self._pose(body, link)
            origin, turn = poses[body, link]
            places[vertex] = origin + turn @ local
        self.sheet.take(np.array([places[int(vertex)] for vertex in self.sheet.held]))

    def _pose(self, body: int, link: int) -> tuple[np.ndarray, np.ndarray]:
        if body < 0:
            return np.zeros(3), np.eye(3)
        client = self.room.client
        if link < 0:
            place, turn = client.getBasePositionAndOrientation(body)
        else:
            place, turn = client.getLinkState(body, link, computeForwardKinematics=1)[4:6]
        return np.array(place), matrix(turn)

"""A room whose cloth is made of springs: PyBullet moves what is rigid, `sheet.py` the cloth; they meet at each step.

Stands in for `SoftWorld` and `Cloth` of `sim/bullet`.  Rigid bodies make their step first, under what the cloth did to
them at the last one; then the cloth makes its own among where they have come to.  What holds cloth takes the held
vertices along and does not feel them: the load is measured and told (`SpringCloth.load`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, NamedTuple

import numpy as np

from ..bullet.cloth import ClothBody, refuse_unstable
from ..bullet.soft_world import GRAVITY, SOLVER_ITERATIONS
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
        numbered: how many there have been.
    """

    def __init__(self, time_step: float) -> None:
        from ..bullet_client import direct_client  # pybullet is loaded only where something is simulated

        self.client: Any = direct_client()
        self.time_step, self.unit = time_step, ROOM
        self.client.setGravity(0.0, 0.0, -ROOM.force(GRAVITY))
        self.client.setPhysicsEngineParameter(
            numSolverIterations=SOLVER_ITERATIONS, solverResidualThreshold=ROOM.residual
        )
        self.client.setTimeStep(ROOM.time(time_step))
        self.cloths: list[SpringCloth] = []
        self.numbered = 0
        self._solids: Solids | None = None

    def step(self) -> None:
        """Pass one time step."""
        self.client.stepSimulation()
        if not self.cloths:
            return
        if self._solids is None:
            self._solids = Solids(self.client, ROOM.per_second)
        else:
            self._solids.read(self.time_step)
        given = np.zeros((len(self._solids.friction), 7))
        for cloth in self.cloths:
            cloth.follow()
            cloth.sheet.step(self._solids, given)
        self._solids.push(given, self.time_step)

    def close(self) -> None:
        """End the client."""
        self.client.disconnect()


class _Pin(NamedTuple):
    vertex: int
    local: np.ndarray  # (3,) where it is held, in the holder's frame [m]
    body: int
    link: int


class SpringCloth(ClothBody):
    """One gown, or another cloth, in a room of springs.

    Args:
        room: where it moves.
        mesh: rest shape; its spec holds mass and stiffness.
        vertices: (V, 3) where it starts, at rest, map frame [m].
        meets_itself: whether its folds keep apart.

    Raises:
        UnstableClothError: the springs would be unstable at the room's time step.
    """

    def __init__(self, room: SpringRoom, mesh: GownMesh, vertices: np.ndarray, meets_itself: bool = False) -> None:
        refuse_unstable(mesh, room.time_step)
        self.room, self.mesh = room, mesh
        self.body, room.numbered = room.numbered, room.numbered + 1
        self.sheet = Sheet(mesh, vertices, room.time_step, meets_itself)
        self._pins: dict[int, _Pin] = {}
        self._pinned = 0  # pins so far
        self._group()
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
        held = [int(k) for k in ids]
        self.sheet.hold(held)
        origin, turn = self._pose(body, link)
        local = (self.sheet.x[held] - origin) @ turn
        pins = list(range(self._pinned, self._pinned + len(held)))
        self._pinned += len(held)
        for n, pin in enumerate(pins):
            self._pins[pin] = _Pin(held[n], local[n], body, link)
        self._group()
        return pins

    def unpin(self, constraints: Iterable[int]) -> None:
        """Let pinned vertices go, but for those that something else holds too."""
        gone = [self._pins.pop(pin).vertex for pin in constraints]
        still = {pin.vertex for pin in self._pins.values()}
        self.sheet.release(vertex for vertex in gone if vertex not in still)
        self._group()

    def _group(self) -> None:
        """Sort the pins by what holds them."""
        self._groups: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}
        for holder in {(pin.body, pin.link): None for pin in self._pins.values()}:
            mine = [pin for pin in self._pins.values() if (pin.body, pin.link) == holder]
            self._groups[holder] = (np.array([pin.vertex for pin in mine]), np.array([pin.local for pin in mine]))

    def load(self, held: Collection[int], vertices: np.ndarray) -> np.ndarray:
        """(3,) force that the cloth exerts on whatever holds the vertices `held` [N], of the last 10 ms."""
        return self.sheet.load[list(held)].sum(axis=0)

    def follow(self) -> None:
        """Take held vertices along with what holds them."""
        for holder, (vertices, local) in self._groups.items():
            origin, turn = self._pose(*holder)
            self.sheet.take(vertices, origin + local @ turn.T)

    def _pose(self, body: int, link: int) -> tuple[np.ndarray, np.ndarray]:
        if body < 0:
            return np.zeros(3), np.eye(3)
        client = self.room.client
        if link < 0:
            place, turn = client.getBasePositionAndOrientation(body)
        else:
            place, turn = client.getLinkState(body, link, computeForwardKinematics=1)[4:6]
        return np.array(place), matrix(*turn)

"""The objects that a task has put into the room: loaded, held, felt by the person, drawn and recorded.

They meet cloth, bed and person in the room's client.  The robot, whose links move in a client of their own, meets them
between its fingers only (an assumption named in docs/assumptions.md).
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..obj_file import read_obj, write_obj
from ..render.solids import box_mesh, capsule_mesh, cylinder_mesh, sphere_mesh
from ..scene.objects import Box, Colour, MeshObject, ObjectError, RoomObject, Sheet, UrdfObject, placed, sheet_mesh
from ..scene.person_spec import ARM_SEGMENTS, PERSON_PARTS, arm_part, part_of
from ..world import SIDES
from .cloth import ClothBody
from .engines import ClothEngine, Room
from .hook import Hook
from .person import Person
from .person_force import ForceBalance
from .units import ROOM

SOFT_DAMPING = 0.6  # of a soft skin, in its critical damping by the object's mass
SENSED = 0.04  # the force on a part follows in this time, as the wrists' sensors do [s]
PADS = (-0.028, -0.014, 0.0)  # depths at which a ray is cast from finger to finger [m]

Part = tuple[int, np.ndarray, np.ndarray]  # link, vertices in its frame, triangles


class RoomObjects:
    """All objects of a run, by name.

    Args:
        engine: of the sheets.
        soft: the room.
        person: who is in it.
        bed_top: height of the mattress [m].

    Attributes:
        cloths: name -> sheet.
        bodies: name -> rigid body.
        part_force: (k,) force of rigid objects on each of `PERSON_PARTS`, as a sensor would feel it [N].
    """

    def __init__(self, engine: ClothEngine, soft: Room, person: Person, bed_top: float) -> None:
        self._engine, self._soft, self._person, self._bed_top = engine, soft, person, bed_top
        self._client: Any = soft.client
        self.cloths: dict[str, ClothBody] = {}
        self.bodies: dict[str, int] = {}
        self._moving: list[int] = []  # bodies that are not fixed
        self._hooks: dict[str, Hook] = {}
        self._balances: dict[str, ForceBalance] = {}
        self._parts: dict[str, list[Part]] = {}
        self._colours: dict[str, Colour] = {}
        self.part_force = np.zeros(len(PERSON_PARTS))
        self._rested: dict[str, np.ndarray] = {}

    def __iter__(self) -> Iterator[str]:
        """Their names, in the order in which they came."""
        return iter(self._colours)

    # -- loading -------------------------------------------------------------------------------------------

    def add(self, item: RoomObject) -> None:
        """Load an object.

        Raises:
            ObjectError: the name is taken, or PyBullet cannot load it.
        """
        if item.name in self._colours:
            raise ObjectError(f"there is an object {item.name!r} already")
        if isinstance(item, Sheet):
            self._add_sheet(item)
        elif isinstance(item, (Box, MeshObject, UrdfObject)):
            self._add_rigid(item)
        else:
            raise ObjectError(f"object {item.name!r} is a {type(item).__name__}: Box, MeshObject, UrdfObject or Sheet")
        self._colours[item.name] = item.colour

    def _add_sheet(self, item: Sheet) -> None:
        mesh = sheet_mesh(item)
        start = placed(item, mesh.vertices)
        cloth = self.cloths[item.name] = self._engine.cloth(self._soft, mesh, start)
        self._balances[item.name] = ForceBalance(self._person, item.mass, self._bed_top)
        if item.hung_by is not None:
            place = np.array(item.position_in_map)
            nearest = int(np.argmin(np.linalg.norm(start - place, axis=1)))
            self._hooks[item.name] = Hook(self._client, cloth, place, nearest)

    def _add_rigid(self, item: Box | MeshObject | UrdfObject) -> None:
        c, turn = self._client, [0.0, 0.0, math.sin(item.yaw / 2), math.cos(item.yaw / 2)]
        if isinstance(item, UrdfObject):
            body, fixed = self._load_urdf(item, turn), item.fixed
        else:
            fixed = item.mass == 0.0
            shape = self._shape(item)
            body = c.createMultiBody(item.mass, shape, basePosition=item.position_in_map, baseOrientation=turn)
        for link in range(-1, c.getNumJoints(body)):
            c.changeDynamics(
                body, link, lateralFriction=item.friction, linearDamping=0.0, angularDamping=0.0, jointDamping=0.0
            )
            c.changeDynamics(body, link, activationState=c.ACTIVATION_STATE_DISABLE_SLEEPING)
        if isinstance(item, Box) and item.stiffness is not None:
            self._person.give_skin()
            damping = 2.0 * SOFT_DAMPING * np.sqrt(item.stiffness * max(item.mass, 0.01))
            c.changeDynamics(
                body, -1, contactStiffness=ROOM.force(item.stiffness), contactDamping=ROOM.rate(float(damping))
            )
        self.bodies[item.name] = body
        if not fixed:
            self._moving.append(body)
        self._parts[item.name] = self._drawn_parts(item, body)

    def _shape(self, item: Box | MeshObject) -> int:
        c = self._client
        if isinstance(item, Box):
            return c.createCollisionShape(c.GEOM_BOX, halfExtents=[edge / 2 for edge in item.size])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mesh.obj"
            write_obj(path, *item.mesh())  # as it was read: nothing else reaches PyBullet
            return c.createCollisionShape(c.GEOM_MESH, fileName=str(path))

    def _load_urdf(self, item: UrdfObject, turn: list[float]) -> int:
        from ..bullet_client import pybullet, silence

        try:
            with silence():
                return self._client.loadURDF(
                    str(item.file), basePosition=item.position_in_map, baseOrientation=turn, useFixedBase=item.fixed
                )
        except pybullet.error as error:
            raise ObjectError(f"object {item.name!r}: PyBullet cannot load {item.file}") from error

    def _drawn_parts(self, item: Box | MeshObject | UrdfObject, body: int) -> list[Part]:
        if isinstance(item, Box):
            half = np.array(item.size) / 2
            return [(-1, *box_mesh(-half, half))]
        if isinstance(item, MeshObject):
            # PyBullet puts a body at its shape's centre of mass only for URDF files: here the origin is the mesh's
            return [(-1, *item.mesh())]
        links = range(-1, self._client.getNumJoints(body))
        return [part for link in links for part in _collision_parts(self._client, body, link)]

    # -- where they are ------------------------------------------------------------------------------------

    def states(self) -> dict[str, np.ndarray]:
        """Position and quaternion x, y, z, w (7,) of each rigid object, vertices (V, 3) of each sheet, in the map."""
        poses = {name: self._client.getBasePositionAndOrientation(body) for name, body in self.bodies.items()}
        rigid = {name: np.concatenate(pose) for name, pose in poses.items()}
        return {name: rigid[name] if name in rigid else self.cloths[name].vertices() for name in self}

    def faces(self) -> dict[str, np.ndarray]:
        """(F, 3) triangles of each sheet."""
        return {name: cloth.mesh.faces for name, cloth in self.cloths.items()}

    def drawn(self) -> dict[str, np.ndarray]:
        """(V, 3) vertices of every object as it is drawn, in the map [m]."""
        return {name: self._vertices(name) for name in self}

    def look(self, name: str) -> tuple[np.ndarray, np.ndarray, Colour]:
        """Vertices (V, 3) in the map, triangles (F, 3) and colour of an object."""
        if name in self.cloths:
            return self._vertices(name), self.cloths[name].mesh.faces, self._colours[name]
        faces, start = [], 0
        for _, vertices, triangles in self._parts[name]:
            faces.append(triangles + start)
            start += len(vertices)
        return self._vertices(name), np.vstack(faces), self._colours[name]

    def _vertices(self, name: str) -> np.ndarray:
        if name in self.cloths:
            return self.cloths[name].vertices()
        placed = []
        for link, vertices, _ in self._parts[name]:
            if link < 0:
                position, turn = self._client.getBasePositionAndOrientation(self.bodies[name])
            else:
                position, turn = self._client.getLinkState(self.bodies[name], link, computeForwardKinematics=1)[:2]
            placed.append(vertices @ Rotation.from_quat(turn).as_matrix().T + position)
        return np.vstack(placed)

    def moved(self) -> float:
        """How far anything has moved since the last call [m]; infinite at the first."""
        now, before, self._rested = self.states(), self._rested, {}
        self._rested = now
        far = [np.inf if name not in before else float(np.abs(now[name] - before[name]).max()) for name in now]
        return max(far, default=0.0)

    # -- what they do --------------------------------------------------------------------------------------

    def before_step(self) -> None:
        """Hooks keep still."""
        for hook in self._hooks.values():
            hook.before_step()

    def watch(self, duration: float, held: Mapping[int, Collection[int]]) -> None:
        """Take sheets off hooks that no longer carry them, feel what touches the person; every `duration` [s].

        Args:
            duration: since the last time [s].
            held: body of each sheet that hands hold -> its vertices in them.
        """
        for name, hook in self._hooks.items():
            cloth = self.cloths[name]
            if hook.holds:
                hook.watch(duration, held.get(cloth.body, ()), cloth.vertices())
        if self._moving:
            now = np.linalg.norm(self._pressing(), axis=1)
            self.part_force += (1.0 - math.exp(-duration / SENSED)) * (now - self.part_force)

    def _pressing(self) -> np.ndarray:
        """(k, 3) force of rigid objects on each of `PERSON_PARTS` in this step [N]."""
        total = np.zeros((len(PERSON_PARTS), 3))
        arms = {
            link: arm_part(arm, segment)
            for arm, side in enumerate(SIDES)
            for segment, link in zip(range(len(ARM_SEGMENTS)), self._person.links[side], strict=True)
        }
        trunk = {body: part_of(name) for name, body in self._person.trunk_bodies.items()}
        for body in self._moving:
            for contact in self._client.getContactPoints(bodyA=body):
                other, link = contact[2], contact[4]
                part = trunk.get(other) if other != self._person.body else arms.get(link)
                if part is not None:
                    total[part] += np.array(contact[7]) * (contact[9] / ROOM.force(1.0))
        return total

    def cloth_force(self, time: float, loads: dict[int, np.ndarray]) -> np.ndarray:
        """(k,) force of the sheets on each of `PERSON_PARTS` [N].

        Args:
            time: world clock [s].
            loads: body of a sheet -> (3,) force that it exerts on the hands that hold it [N].
        """
        total = np.zeros(len(PERSON_PARTS))
        for name, cloth in self.cloths.items():
            vertices = cloth.vertices()
            hook = self._hooks[name].load(vertices) if name in self._hooks else np.zeros(3)
            held = -loads.get(cloth.body, np.zeros(3)) - hook
            total += self._balances[name].parts(time, vertices, held, {})
        return total

    def between(self, pose_hand_in_map: np.ndarray, opening: float) -> tuple[int, float] | None:
        """The rigid object between fingertips that stand `opening` [m] apart, and how thick it is there [m].

        Args:
            pose_hand_in_map: (4, 4), y along the closing direction, z out of the palm.
            opening: distance of the fingertips [m].
        """
        if not self._moving:
            return None
        ends = [np.array((0.0, sign * opening / 2, depth)) for depth in PADS for sign in (1.0, -1.0)]
        starts = [(pose_hand_in_map[:3, :3] @ end + pose_hand_in_map[:3, 3]).tolist() for end in ends]
        opposite = [starts[k + 1 if k % 2 == 0 else k - 1] for k in range(len(starts))]
        hits = self._client.rayTestBatch(starts, opposite)
        best: tuple[int, float] | None = None
        for one, other in zip(hits[::2], hits[1::2], strict=True):
            if one[0] == other[0] and one[0] in self._moving:
                thickness = max(0.0, 1.0 - one[2] - other[2]) * opening
                if best is None or thickness > best[1]:
                    best = one[0], thickness
        return best


def _collision_parts(client: Any, body: int, link: int) -> list[Part]:
    """What a link of a description is drawn as: its collision shapes."""
    parts: list[Part] = []
    for _, _, kind, size, file, position, turn in client.getCollisionShapeData(body, link):
        along = np.array((0.0, 0.0, size[0] / 2))
        if kind == client.GEOM_BOX:
            vertices, faces = box_mesh(-np.array(size) / 2, np.array(size) / 2)
        elif kind == client.GEOM_SPHERE:
            vertices, faces = sphere_mesh(np.zeros(3), size[0])
        elif kind == client.GEOM_CAPSULE:
            vertices, faces = capsule_mesh(-along, along, size[1])
        elif kind == client.GEOM_CYLINDER:
            vertices, faces = cylinder_mesh(-along, along, size[1])
        elif kind == client.GEOM_MESH and str(file.decode()).endswith(".obj"):
            vertices, faces, _ = read_obj(Path(file.decode()))
            vertices = vertices * size
        else:
            continue
        parts.append((link, vertices @ Rotation.from_quat(turn).as_matrix().T + position, faces))
    return parts

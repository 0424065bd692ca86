"""Does the robot hit itself or a box in the room?  Its capsules and boxes, tested by coal where they may be near."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..extras import later
from ..world import SIDES
from .far_apart import FarApart, Solid
from .kinematics import Kinematics, joint_places
from .shape import Shape

if TYPE_CHECKING:
    import coal  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
else:
    coal = later("coal")
    pin = later("pinocchio")


EPSILON = 1e-6  # [m] a posture is as near as itself
Contacts = Mapping[int, float]  # pair of shapes -> what lies between them, below 0 where they are in each other [m]


class CollisionChecker:
    """Tests arm postures against the robot itself and against boxes of the room.

    The fingers are left out: they are meant to touch things.

    Args:
        kinematics: the robot.
        boxes: (k, 2, 3) lower and upper corners of axis-aligned boxes in the map that hands and arms must not
            enter, for instance the bed [m].
        margin: closest approach that is no collision [m].
        room: more than that asked of a free posture, so that a smooth motion may cut the corners of a free path [m].

    Attributes:
        robot: whose arms these are.
        head_pan: angle of its head where none is given [rad].
    """

    head_pan: float = 0.0

    def __init__(
        self, kinematics: Kinematics, boxes: np.ndarray | None = None, margin: float = 0.01, room: float = 0.008
    ) -> None:
        self._kinematics = kinematics
        model = kinematics.model
        self._geometry = pin.GeometryModel()
        self._names: list[str] = []
        self._solids: list[Solid] = []
        ids: dict[str, list[int]] = {}
        self.robot = robot = kinematics.robot
        tested = {link for pair in robot.own_pairs for link in pair}
        tested |= {f"{side}_{link}" for side in SIDES for link in robot.limbs}
        for link, shapes in robot.shapes.items():
            if link not in tested:
                continue
            frame = model.frames[model.getFrameId(link)]
            ids[link] = [self._add(link, frame.parentJoint, frame.placement, shape) for shape in shapes]
        self._pairs: list[tuple[int, int]] = []
        for a, b in robot.own_pairs:
            self._pairs += [(m, n) for m in ids[a] for n in ids[b]]
        limbs = [n for side in SIDES for link in robot.limbs for n in ids[f"{side}_{link}"]]
        for k, (lower, upper) in enumerate(np.zeros((0, 2, 3)) if boxes is None else np.asarray(boxes, float)):
            shape = Shape(kind="box", size=tuple(upper - lower), xyz=tuple((lower + upper) / 2))
            box = self._add(f"box {k}", 0, pin.SE3.Identity(), shape)
            self._pairs += [(n, box) for n in limbs]
        for m, n in self._pairs:
            self._geometry.addCollisionPair(pin.CollisionPair(m, n))
        self._data = pin.GeometryData(self._geometry)
        self._roomy = pin.GeometryData(self._geometry)
        for data, closest in ((self._data, margin), (self._roomy, margin + room)):
            for request in data.collisionRequests:
                request.security_margin = closest
        self._margin, self._room = margin, margin + room
        self._far, self._places = FarApart(self._solids, self._pairs), joint_places(kinematics.data)

    def free(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float | None = None,
        *,
        leaving: Contacts | None = None,
    ) -> bool:
        """Whether arms (2, n) at these angles touch nothing, with some room.

        Args:
            pose_base_in_map: (3,) where the base stands.
            arm_positions: (2, n) [rad].
            head_pan: of the robot's head [rad]; `head_pan` of this checker if not given.
            leaving: contacts that a motion begins with; those may stay as near as they are, and come no nearer.
        """
        pan = self.head_pan if head_pan is None else head_pan
        q = self._kinematics.configuration(pose_base_in_map, arm_positions, pan)
        if not self._touches(q, roomy=True, stop_at_first=not leaving):
            return True
        return bool(leaving) and all(leaving.get(n, np.inf) - EPSILON <= gap for n, gap in self._near().items())

    def free_along(
        self, pose_base_in_map: np.ndarray, postures: np.ndarray, head_pan: float | None = None
    ) -> Iterator[bool]:
        """What `free` says of each of the postures (k, 2, n) of a motion [rad], at least one, in turn."""
        for q in self._along(pose_base_in_map, postures, head_pan):
            yield not self._touches(q, roomy=True, stop_at_first=True)

    def contacts(
        self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float | None = None
    ) -> Contacts:
        """What is too near for `free` where the arms (2, n) are, for a motion that leaves it."""
        pan = self.head_pan if head_pan is None else head_pan
        q = self._kinematics.configuration(pose_base_in_map, arm_positions, pan)
        return self._near() if self._touches(q, roomy=True, stop_at_first=False) else {}

    def collisions(
        self, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float | None = None
    ) -> list[tuple[str, str]]:
        """Names of all pairs that are too close, for a message."""
        return next(self.collisions_along(pose_base_in_map, np.asarray(arm_positions, float)[None], head_pan))

    def collisions_along(
        self, pose_base_in_map: np.ndarray, postures: np.ndarray, head_pan: float | None = None
    ) -> Iterator[list[tuple[str, str]]]:
        """What `collisions` says of each of the postures (k, 2, n) of a motion [rad], at least one, in turn."""
        for q in self._along(pose_base_in_map, postures, head_pan):
            yield self._hits(q)

    def _along(self, pose_base_in_map: np.ndarray, postures: np.ndarray, head_pan: float | None) -> np.ndarray:
        """The joint vector (k, nq) of each posture."""
        return self._kinematics.configurations(
            pose_base_in_map, postures, self.head_pan if head_pan is None else head_pan
        )

    def _hits(self, q: np.ndarray) -> list[tuple[str, str]]:
        """Names of all pairs that are too close."""
        if not self._touches(q, roomy=False, stop_at_first=False):
            return []  # asking every pair's result takes longer than all the tests do
        hit = [
            pair for pair, result in zip(self._pairs, self._data.collisionResults, strict=True) if result.isCollision()
        ]
        return list(dict.fromkeys((self._names[m], self._names[n]) for m, n in hit))

    def _near(self) -> Contacts:
        """Of the posture that was computed last."""
        near = [n for n, result in enumerate(self._roomy.collisionResults) if result.isCollision()]
        return {n: pin.computeDistance(self._geometry, self._roomy, n).min_distance for n in near}

    def _touches(self, q: np.ndarray, *, roomy: bool, stop_at_first: bool) -> bool:
        """Whether any pair is too close; coal's results are those of `q` only where one is."""
        model, data = self._kinematics.model, self._kinematics.data
        pin.forwardKinematics(model, data, q)
        if self._far.all(self._places, self._room if roomy else self._margin):
            return False
        return pin.computeCollisions(
            model, data, self._geometry, self._roomy if roomy else self._data, q, stop_at_first
        )

    def _add(self, name: str, joint: int, placement: pin.SE3, shape: Shape) -> int:
        solid = coal.Box(*shape.size) if shape.kind == "box" else coal.Capsule(*shape.size)
        local = pin.SE3(pin.rpy.rpyToMatrix(*shape.rpy), np.array(shape.xyz))
        whole = placement * local
        entry = pin.GeometryObject(f"{name} {len(self._names)}", joint, whole, solid)
        self._names.append(name)
        self._solids.append(Solid(joint=joint, shape=shape, turn=whole.rotation, centre=whole.translation))
        return self._geometry.addGeometryObject(entry)

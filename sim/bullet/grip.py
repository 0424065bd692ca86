"""What closing the fingers takes hold of: exactly the cloth between them, or the arm.

Cloth: every triangle that reaches into the volume between the open fingertips is taken when they close, all
layers that are there, and it slips out when the load passes the friction of the pads.  An arm: taken when its
axis runs between the fingers.  A rigid object: taken where it keeps them apart.  The robot learns of none of them
except through its own sensors.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..scene.person_spec import ARM_SEGMENTS, arm_part
from ..world import SIDES, Side
from .cloth import ClothBody
from .handle import Handle
from .person import Person
from .units import ROOM

if TYPE_CHECKING:
    from .objects import RoomObjects

PAD_HALF_WIDTH = 0.011  # Robotiq 2F-85 pads are 22 mm wide [m]
PAD_DEPTH = (-0.038, 0.004)  # from the palm side of the pads to just past the fingertips [m]
REACH = 0.045  # vertices of a taken triangle up to this far from the grip are held: one cell of the mesh [m]
CLOSED = 0.010  # opening at which cloth is held [m]
REOPENED = 0.020  # opening at which it is let go [m]
FRICTION_CLOTH = 0.6  # rubber pads on cotton
FRICTION_SKIN = 0.6  # rubber pads on vinyl skin
SMOOTHING = 0.5  # share of a new load reading, taken every 20 ms
CATCH = 0.020  # an arm whose axis is this near to the grip is centred by the closing fingers [m]
STEP = 0.003  # a command to close by more is no step of a slow closing [m]
TOUCH = 0.003  # fingers at most this much further apart than an arm is wide touch it [m]
ARM_SLIP = 0.03  # an arm that has moved this far in the grip is lost [m]
_SAMPLES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 4.0  # barycentric, (15, 3)


@dataclass(frozen=True)
class Pinched:
    """Cloth between the fingers: vertices to hold and how many layers they belong to."""

    vertices: tuple[int, ...]
    layers: int


def cloth_between(vertices: np.ndarray, faces: np.ndarray, pose_hand_in_map: np.ndarray, opening: float) -> Pinched:
    """The cloth in the volume between fingertips that stand `opening` [m] apart.

    Args:
        vertices: (V, 3) map frame [m].
        faces: (F, 3).
        pose_hand_in_map: (4, 4), y along the closing direction, z out of the palm.
        opening: distance of the fingertips before they close [m].
    """
    local = (vertices - pose_hand_in_map[:3, 3]) @ pose_hand_in_map[:3, :3]
    near = np.flatnonzero((np.abs(local[faces]).min(axis=1) < 0.12).all(axis=1))
    points = np.einsum("sk,fkd->fsd", _SAMPLES, local[faces[near]])  # (n, 15, 3)
    inside = (
        (np.abs(points[..., 0]) <= PAD_HALF_WIDTH)
        & (np.abs(points[..., 1]) <= opening / 2)
        & (points[..., 2] >= PAD_DEPTH[0])
        & (points[..., 2] <= PAD_DEPTH[1])
    )
    taken = near[inside.any(axis=1)]
    if len(taken) == 0:
        return Pinched((), 0)
    ids = np.unique(faces[taken])
    centre = points[inside].mean(axis=0)
    distance = np.linalg.norm(local[ids] - centre, axis=1)
    held = ids[distance <= max(REACH, float(np.sort(distance)[min(2, len(ids) - 1)]))]
    return Pinched(tuple(int(k) for k in held), _components(faces[taken]))


def _components(faces: np.ndarray) -> int:
    """Number of patches of triangles that share no vertex."""
    groups: list[set[int]] = []
    for face in faces:
        mine = set(map(int, face))
        for group in [g for g in groups if g & mine]:
            mine |= group
            groups.remove(group)
        groups.append(mine)
    return len(groups)


def held_vertices(grips: Iterable[Grip]) -> dict[int, set[int]]:
    """Body of each cloth that hands hold -> its vertices in them."""
    held: dict[int, set[int]] = {}
    for grip in grips:
        if grip.kind == "cloth":
            held.setdefault(grip.cloth.body, set()).update(grip.vertices)
    return held


class Grip:
    """One gripper's hold.

    Attributes:
        kind: `nothing`, `cloth`, `arm` or `object`.
        cloth: that it holds, or held last; the gown at first.
        layers: of the cloth held.
        part: index in `PERSON_PARTS` of the arm part held, or None.
        arm: which arm is held: -1 none, 0 left, 1 right.
        thickness: what keeps the fingers apart [m].
    """

    def __init__(self, client: Any, side: Side, handle: Handle, cloth: ClothBody, person: Person) -> None:
        self.client, self.side, self.handle, self.cloth, self.person = client, side, handle, cloth, person
        self.kind = "nothing"
        self.layers = 0
        self.part: int | None = None
        self.arm = -1
        self.thickness = 0.0
        self._pins: list[int] = []
        self._held: tuple[int, ...] = ()
        self._cloth_load = np.zeros(3)
        self._constraint: int | None = None
        self._arm_link = self._body = -1
        self._arm_local = np.zeros(3)
        self._open_before = 0.085
        self._armed = True

    def on_command(self, opening: float, now_open: float) -> None:
        """A new opening is commanded; remember how far the fingers were apart before they close.

        Fingers that have what is rigid and are told to close on do not take it again as they open.  Those that close
        step by step, as slowly as round an arm, began to at the first step.
        """
        if self.kind in ("arm", "object"):
            return
        if opening < now_open - STEP or (opening < now_open and not self._armed):
            self._open_before, self._armed = now_open, True
        elif opening > now_open + STEP:
            self._armed = False

    def catch_arm(self, pose_hand_in_map: np.ndarray, opening: float, force: float, only: int | None = None) -> bool:
        """Take the arm if its axis runs between the closing fingers and they touch it; tells whether it did.

        Args:
            pose_hand_in_map: (4, 4).
            opening: of the fingers now [m].
            force: of the fingers [N].
            only: index in `PERSON_PARTS` of the one part that can be taken; None for any.
        """
        if self.kind != "nothing" or not self._armed:
            return False
        if opening > 2 * self.person.spec.arm_radii.max() + TOUCH:
            return False
        found = self._arm_between(pose_hand_in_map, opening, only)
        if found is None or opening > 2 * found[3] + TOUCH:
            return False
        arm, part, point, radius = found
        link = self.person.links[SIDES[arm]][part]
        self.handle.reset(pose_hand_in_map)
        state = self.client.getLinkState(self.person.body, link, computeForwardKinematics=1)
        inverse = self.client.invertTransform(state[0], state[1])
        local = self.client.multiplyTransforms(*inverse, point.tolist(), (0, 0, 0, 1))[0]
        offset = point - pose_hand_in_map[:3, 3]  # the handle's axes are the map's at reset
        self._constraint = self.client.createConstraint(
            self.handle.body,
            self.handle.link,
            self.person.body,
            link,
            self.client.JOINT_POINT2POINT,
            (0, 0, 0),
            offset.tolist(),
            local,
        )
        self.client.changeConstraint(self._constraint, maxForce=ROOM.force(2 * FRICTION_SKIN * force))
        self.kind, self.thickness, self._armed = "arm", 2 * radius, False
        self.part, self.arm = arm_part(arm, part), arm
        self._arm_link, self._arm_local, self._arm_offset = link, np.array(local), offset
        return True

    def catch_object(self, objects: RoomObjects, pose_hand_in_map: np.ndarray, opening: float, force: float) -> bool:
        """Take a rigid object that is as thick as the fingers now stand apart; tells whether it did."""
        if self.kind != "nothing" or not self._armed:
            return False
        found = objects.between(pose_hand_in_map, self._open_before)
        if found is None or opening > found[1] + 0.003:
            return False
        body, self.thickness = found
        self.handle.reset(pose_hand_in_map)
        place = self.client.getLinkState(self.handle.body, self.handle.link, computeForwardKinematics=1)
        at = self.client.getBasePositionAndOrientation(body)
        local = self.client.multiplyTransforms(*self.client.invertTransform(*at), place[4], place[5])
        self._constraint = self.client.createConstraint(
            self.handle.body,
            self.handle.link,
            body,
            -1,
            self.client.JOINT_FIXED,
            (0, 0, 0),
            (0, 0, 0),
            local[0],
            (0, 0, 0, 1),
            local[1],
        )
        self.client.changeConstraint(self._constraint, maxForce=ROOM.force(2 * FRICTION_SKIN * force))
        self.kind, self._armed = "object", False
        self._body, self._arm_local = body, np.array(local[0])
        return True

    def take_any_cloth(self, cloths: Iterable[ClothBody], pose_hand_in_map: np.ndarray) -> None:
        """The fingers have closed: hold what they have of the first cloth that is between them."""
        for cloth in cloths if self._armed else ():
            self._armed, self.cloth = True, cloth
            self.take_cloth(cloth.vertices(), pose_hand_in_map)
            if self.kind == "cloth":
                return

    def take_cloth(self, vertices: np.ndarray, pose_hand_in_map: np.ndarray) -> None:
        """The fingers have closed: hold what was between them when they began to."""
        if self.kind != "nothing" or not self._armed:
            return
        self._armed = False
        pinched = cloth_between(vertices, self.cloth.mesh.faces, pose_hand_in_map, self._open_before)
        if not pinched.vertices:
            return
        self.handle.reset(pose_hand_in_map)
        self._held = pinched.vertices
        self._pins = self.cloth.pin(self._held, self.handle.body, self.handle.link)
        self._cloth_load = self.cloth.load(self._held, vertices)
        self.kind, self.layers, self.thickness = "cloth", pinched.layers, 0.0

    def release(self) -> None:
        """Let go of whatever is held."""
        if self._pins:
            self.cloth.unpin(self._pins)
        self._pins = []
        if self._constraint is not None:
            self.client.removeConstraint(self._constraint)
            self._constraint = None
        self.kind, self.layers, self.part, self.arm, self.thickness = "nothing", 0, None, -1, 0.0

    @property
    def vertices(self) -> tuple[int, ...]:
        """Of the cloth that is held."""
        return self._held if self.kind == "cloth" else ()

    @property
    def load(self) -> np.ndarray:
        """(3,) force of what is held on the hand, map frame [N]."""
        if self.kind in ("arm", "object"):
            return self.handle.load
        return self._cloth_load.copy() if self.kind == "cloth" else np.zeros(3)

    def watch(self, vertices: np.ndarray, force: float) -> None:
        """Feel the load; lose the hold when it passes the pads' friction or the arm has slid out: every 20 ms."""
        if self.kind == "cloth":
            self._cloth_load += SMOOTHING * (self.cloth.load(self._held, vertices) - self._cloth_load)
            if float(np.linalg.norm(self._cloth_load)) > 2 * FRICTION_CLOTH * force:
                self.release()
        elif self.kind == "arm":
            state = self.client.getLinkState(self.person.body, self._arm_link)
            held = self.client.multiplyTransforms(state[0], state[1], self._arm_local.tolist(), (0, 0, 0, 1))[0]
            pose = self.client.getLinkState(self.handle.body, self.handle.link)
            wanted = self.client.multiplyTransforms(pose[0], pose[1], self._arm_offset.tolist(), (0, 0, 0, 1))[0]
            if np.linalg.norm(np.subtract(held, wanted)) > ARM_SLIP:
                self.release()
        elif self.kind == "object":
            at = self.client.getBasePositionAndOrientation(self._body)
            held = self.client.multiplyTransforms(*at, self._arm_local.tolist(), (0, 0, 0, 1))[0]
            if np.linalg.norm(np.subtract(held, self.handle.position())) > ARM_SLIP:
                self.release()

    def _arm_between(
        self, pose_hand_in_map: np.ndarray, opening: float, only: int | None
    ) -> tuple[int, int, np.ndarray, float] | None:
        """(arm, part, point on its axis, radius) of the arm part between the fingers.

        It is the nearest one, but at a joint, where two are as near, the thicker one, which the fingers touch first:
        waiting for the thinner one they would push the arm aside, by up to 2 mm with 10 N.
        """
        arms, radii = self.person.arms(), self.person.radii()
        origin, turn = pose_hand_in_map[:3, 3], pose_hand_in_map[:3, :3]
        best: tuple[tuple[bool, float], tuple[int, int, np.ndarray, float]] | None = None
        for arm in range(2):
            for part in range(len(ARM_SEGMENTS)):
                if 2 * radii[arm, part] >= self._open_before or only not in (None, arm_part(arm, part)):
                    continue
                a, b = arms[arm, part], arms[arm, part + 1]
                f = float(np.clip((origin - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0))
                point = a + f * (b - a)
                local = (point - origin) @ turn
                axis = (b - a) / np.linalg.norm(b - a)
                # across the fingers the arm must lie within their stroke, along the approach within the pads' depth
                fits = abs(local[1]) <= CATCH and abs(local[2]) <= 0.03 and abs(axis @ turn[:, 1]) < 0.5
                # what ends before it comes between them is not: a hand was taken 0.17 m away, at a forearm
                fits = fits and (only is not None or abs(local[0]) <= PAD_HALF_WIDTH + CATCH)
                if fits:
                    touched = opening <= 2 * radii[arm, part] + TOUCH and abs(local[0]) <= PAD_HALF_WIDTH
                    nearness = (not touched, float(np.linalg.norm(local)))
                    if best is None or nearness < best[0]:
                        best = (nearness, (arm, part, point, float(radii[arm, part])))
        return best[1] if best else None

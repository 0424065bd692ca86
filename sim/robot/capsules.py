"""The robot as capsules, one or two for each link above the base: for distances to the person, and for contact.

The boxes of `shapes.py` become the capsules that fill them; its capsules stay what they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

from ..compiled import fma, njit
from ..world import SIDES
from . import model
from .kinematics import Kinematics
from .shapes import Shape, collision_shapes

# capsule -> link of `shapes.py`; the base is left out: the map keeps it off the bed
_LIMB = {
    "shoulder": "upper_shoulder",
    "upper_arm": "upper_elbow",
    "elbow": "lower_elbow",
    "forearm": "upper_forearm",
    "wrist_1": "lower_forearm",
    "wrist_2": "wrist",
}


@dataclass(frozen=True, kw_only=True)
class LinkCapsule:
    """A capsule fixed to a link.

    Attributes:
        name: `left_palm_1`, `right_finger_2`, `left_forearm`, `torso_1`, ...
        link: that carries it.
        ends: (2, 3) of its axis, in the link's frame [m].
        radius: [m].
    """

    name: str
    link: str
    ends: np.ndarray
    radius: float


def link_capsules() -> tuple[LinkCapsule, ...]:
    """All capsules: of each arm from the shoulder to the fingers, then torso and head."""
    shapes = collision_shapes()
    capsules = []
    for side in SIDES:
        for name, link in _LIMB.items():
            capsules.append(_of_capsule(f"{side}_{name}", f"{side}_{link}", shapes[f"{side}_{link}"][0]))
        capsules += _palm(f"{side}_palm", f"{side}_gripper")
        capsules += [
            _finger(f"{side}_finger_{n + 1}", f"{side}_finger_{finger}_link", sign)
            for n, (finger, sign) in enumerate((("a", 1.0), ("b", -1.0)))
        ]
    capsules += _upright("torso", "torso", shapes["torso"][0])
    return (*capsules, _of_capsule("head", "head", shapes["head"][0]))


def _of_capsule(name: str, link: str, shape: Shape) -> LinkCapsule:
    radius, length = shape.size
    axis = pin.rpy.rpyToMatrix(*shape.rpy)[:, 2] * length / 2
    return LinkCapsule(name=name, link=link, ends=np.array((shape.xyz - axis, shape.xyz + axis)), radius=radius)


def _palm(name: str, link: str) -> list[LinkCapsule]:
    """Two capsules along the closing direction, at either end of the box."""
    across, closing, height = model.PALM_SIZE
    radius, half = across / 2, (closing - across) / 2
    return [
        LinkCapsule(
            name=f"{name}_{n + 1}", link=link, ends=np.array(((0.0, -half, z), (0.0, half, z))), radius=float(radius)
        )
        for n, z in enumerate((radius, height - radius))
    ]


def _finger(name: str, link: str, sign: float) -> LinkCapsule:
    """As thick as the finger: its pad faces the other one at y = 0."""
    _, thick, long = model.FINGER_SIZE
    radius = float(thick / 2)
    ends = np.array(((0.0, sign * radius, -long + radius), (0.0, sign * radius, -radius)))
    return LinkCapsule(name=name, link=link, ends=ends, radius=radius)


def _upright(name: str, link: str, box: Shape) -> list[LinkCapsule]:
    """Two upright capsules beside each other, as deep as the box."""
    deep, wide, high = box.size
    radius, x, z = deep / 2, box.xyz[0], box.xyz[2]
    lift = high / 2 - radius
    return [
        LinkCapsule(
            name=f"{name}_{n + 1}",
            link=link,
            ends=np.array(((x, y, z - lift), (x, y, z + lift))),
            radius=radius,
        )
        for n, y in enumerate((radius - wide / 2, wide / 2 - radius))
    ]


class RobotCapsules:
    """Where the capsules are for given joint angles.

    Args:
        kinematics: the robot's model.

    Attributes:
        capsules: in the order of the rows.
        names: (r,) of them.
        radii: (r,) [m].
    """

    def __init__(self, kinematics: Kinematics) -> None:
        self.capsules = link_capsules()
        self.names = tuple(capsule.name for capsule in self.capsules)
        self.radii = np.array([capsule.radius for capsule in self.capsules])
        self._kinematics, model_ = kinematics, kinematics.model
        self._asked, self._ends = b"", np.zeros((0, 2, 3))  # for one posture the guard and the skills ask in turn
        frames = [model_.frames[model_.getFrameId(capsule.link)] for capsule in self.capsules]
        self._joints = np.array([frame.parentJoint for frame in frames])
        self._local = np.stack(
            [
                capsule.ends @ frame.placement.rotation.T + frame.placement.translation
                for capsule, frame in zip(self.capsules, frames, strict=True)
            ]
        )  # (r, 2, 3) in the frame of the joint that moves the link
        self._places = _places(kinematics.data)

    def ends(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        gripper_opening: np.ndarray | None = None,
    ) -> np.ndarray:
        """(r, 2, 3) ends of every capsule's axis in the map [m].

        Args:
            pose_base_in_map: (3,) where the base stands [m, m, rad].
            arm_positions: (2, 7) [rad].
            head_pan: [rad].
            gripper_opening: (2,) [m]; closed when omitted.
        """
        robot = self._kinematics
        q = robot.configuration(pose_base_in_map, arm_positions, head_pan, gripper_opening)
        if (asked := q.tobytes()) != self._asked:
            pin.forwardKinematics(robot.model, robot.data, q)
            self._ends = _placed(self._local, self._joints, self._places)
            self._asked = asked
        return self._ends.copy()

    def rows(self, ends: np.ndarray) -> np.ndarray:
        """(r, 7) ends and radius of every capsule, from `ends` (r, 2, 3)."""
        return np.column_stack((ends.reshape(-1, 6), self.radii))


def _places(data: pin.Data) -> np.ndarray:
    """(joints, 12) where pinocchio keeps every joint's pose in the map: rotation by columns, then place.

    A view of its memory, which lives as long as `data` does: asking for the poses one by one would take ten times
    as long as computing them.
    """
    first = data.oMi[0].rotation[:1, 0]
    return np.lib.stride_tricks.as_strided(first, (len(data.oMi), 12), (12 * first.itemsize, first.itemsize))


@njit()
def _placed(local: np.ndarray, joints: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Points (r, 2, 3) in the frames of `joints` (r,), in the map."""
    points = np.empty_like(local)
    for n in range(len(local)):
        place = places[joints[n]]
        for end in range(2):
            x, y, z = local[n, end, 0], local[n, end, 1], local[n, end, 2]
            for k in range(3):
                points[n, end, k] = fma(z, place[6 + k], fma(y, place[3 + k], x * place[k])) + place[9 + k]
    return points

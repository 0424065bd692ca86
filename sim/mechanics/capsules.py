"""The robot as capsules, one or two for each link above the base: for distances to the person, and for contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..compiled import fma, njit
from ..extras import later
from .kinematics import Kinematics, joint_places

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
else:
    pin = later("pinocchio")


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
        self.capsules = kinematics.robot.capsules
        self.names = tuple(capsule.name for capsule in self.capsules)
        self.radii = np.array([capsule.radius for capsule in self.capsules])
        self._kinematics, model_ = kinematics, kinematics.model
        self._asked = b""  # for one posture the guard and the skills ask in turn
        self._ends = np.zeros((len(self.capsules), 2, 3))
        frames = [model_.frames[model_.getFrameId(capsule.link)] for capsule in self.capsules]
        self._joints = np.array([frame.parentJoint for frame in frames])
        self._local = np.stack(
            [
                capsule.ends @ frame.placement.rotation.T + frame.placement.translation
                for capsule, frame in zip(self.capsules, frames, strict=True)
            ]
        )  # (r, 2, 3) in the frame of the joint that moves the link
        self._places = joint_places(kinematics.data)

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
            arm_positions: (2, n) [rad].
            head_pan: [rad].
            gripper_opening: (2,) [m]; closed when omitted.
        """
        robot = self._kinematics
        q = robot.configuration(pose_base_in_map, arm_positions, head_pan, gripper_opening)
        if (asked := q.tobytes()) != self._asked:
            pin.forwardKinematics(robot.model, robot.data, q)
            _place(self._local, self._joints, self._places, self._ends)
            self._asked = asked
        return self._ends.copy()

    def ends_along(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        gripper_opening: np.ndarray | None = None,
    ) -> np.ndarray:
        """(k, r, 2, 3) what `ends` gives for postures (k, 2, n) of the arms, at least one, the rest being the same."""
        robot, ends = self._kinematics, np.empty((len(arm_positions), *self._ends.shape))
        for n, q in enumerate(robot.configurations(pose_base_in_map, arm_positions, head_pan, gripper_opening)):
            pin.forwardKinematics(robot.model, robot.data, q)
            _place(self._local, self._joints, self._places, ends[n])
        return ends

    def rows(self, ends: np.ndarray) -> np.ndarray:
        """(r, 7) ends and radius of every capsule, from `ends` (r, 2, 3)."""
        return np.column_stack((ends.reshape(-1, 6), self.radii))


@njit()
def _place(local: np.ndarray, joints: np.ndarray, places: np.ndarray, points: np.ndarray) -> None:
    """Put points (r, 2, 3), given in the frames of `joints` (r,), in place in the map."""
    for n in range(len(local)):
        place = places[joints[n]]
        for end in range(2):
            x, y, z = local[n, end, 0], local[n, end, 1], local[n, end, 2]
            for k in range(3):
                points[n, end, k] = fma(z, place[6 + k], fma(y, place[3 + k], x * place[k])) + place[9 + k]

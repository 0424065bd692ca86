"""Where everything is: forward kinematics, Jacobians, limits and gravity of the robot, by pinocchio.

The arms are also kept as two seven-joint models in the `base` frame: an inverse-kinematics step on one of
them costs a few microseconds in pinocchio, and the base pose is applied afterwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

from ..compiled import njit
from ..world import CAMERAS, SIDES, Side
from . import model
from .urdf import compose

_CAMERA_FRAMES = {camera: f"{camera}_camera" for camera in CAMERAS}


@dataclass(frozen=True, kw_only=True)
class ArmLimits:
    """Limits of the seven joints of one arm, each (7,): [rad], [rad], [rad/s], [rad/s^2], [N m]."""

    lower: np.ndarray
    upper: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    effort: np.ndarray

    def clip(self, q: np.ndarray) -> np.ndarray:
        """Nearest allowed angles (7,) [rad]."""
        return np.clip(q, self.lower, self.upper)

    def margin(self, q: np.ndarray) -> float:
        """Least distance of an angle of `q` (7,) to its limit [rad]; below zero beyond it."""
        return float(np.min(np.minimum(q - self.lower, self.upper - q)))


def planar_pose(pose_base_in_map: np.ndarray) -> np.ndarray:
    """Transform (4, 4) of a base pose (x [m], y [m], yaw [rad])."""
    x, y, yaw = pose_base_in_map
    return _planar_pose(float(x), float(y), float(yaw))


@njit()
def _planar_pose(x: float, y: float, yaw: float) -> np.ndarray:
    pose = np.eye(4)
    c, s = math.cos(yaw), math.sin(yaw)
    pose[0, 0], pose[0, 1], pose[0, 3] = c, -s, x
    pose[1, 0], pose[1, 1], pose[1, 3] = s, c, y
    return pose


class Kinematics:
    """The robot's kinematic and inertial model.

    Configurations are given as in an `Observation`: base pose (3,), arm angles (2, 7) left then right, head
    pan and gripper openings (2,).  One instance is not safe to use from two threads.

    Attributes:
        limits: `ArmLimits` by side.
        head_range: lowest and highest head pan [rad].
    """

    def __init__(self) -> None:
        self.model = pin.buildModelFromXML(compose(collisions=False))
        self.data = self.model.createData()
        full = self.model
        neutral = pin.neutral(full)
        self._arms: dict[Side, tuple[pin.Model, pin.Data, int]] = {}
        self.limits: dict[Side, ArmLimits] = {}
        self._arm_index = np.array(
            [[full.joints[full.getJointId(name)].idx_q for name in model.arm_joints(side)] for side in SIDES]
        )
        self._finger_index = np.array(
            [[full.joints[full.getJointId(name)].idx_q for name in model.finger_joints(side)] for side in SIDES]
        )
        self._base_index = np.array([full.joints[full.getJointId(name)].idx_q for name in model.BASE_JOINTS])
        self._head_index = full.joints[full.getJointId(model.HEAD_JOINT)].idx_q
        self.head_range = (
            float(full.lowerPositionLimit[self._head_index]),
            float(full.upperPositionLimit[self._head_index]),
        )
        for n, side in enumerate(SIDES):
            keep = set(model.arm_joints(side))
            locked = [full.getJointId(name) for name in full.names[1:] if name not in keep]
            arm = pin.buildReducedModel(full, locked, neutral)
            self._arms[side] = (arm, arm.createData(), arm.getFrameId(f"{side}_hand"))
            index = self._arm_index[n]
            self.limits[side] = ArmLimits(
                lower=full.lowerPositionLimit[index].copy(),
                upper=full.upperPositionLimit[index].copy(),
                velocity=full.velocityLimit[index].copy(),
                acceleration=model.ARM_ACCELERATION.copy(),
                effort=full.effortLimit[index].copy(),
            )
        self._link_frames = {frame.name: n for n, frame in enumerate(full.frames) if frame.type == pin.FrameType.BODY}

    def pose_hand_in_base(self, side: Side, q: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of one hand for its seven angles (7,) [rad]."""
        arm, data, frame = self._arms[side]
        pin.forwardKinematics(arm, data, np.asarray(q, float))
        return pin.updateFramePlacement(arm, data, frame).homogeneous

    def pose_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of one hand for its seven angles (7,) [rad] and a base pose (3,)."""
        return planar_pose(pose_base_in_map) @ self.pose_hand_in_base(side, q)

    def jacobian_hand_in_base(self, side: Side, q: np.ndarray) -> np.ndarray:
        """Jacobian (6, 7) of the hand point: linear, then angular velocity, along the axes of `base`."""
        arm, data, frame = self._arms[side]
        return pin.computeFrameJacobian(arm, data, np.asarray(q, float), frame, pin.LOCAL_WORLD_ALIGNED)

    def jacobian_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Jacobian (6, 7) of the hand point along the axes of `map`."""
        rotation = planar_pose(pose_base_in_map)[:3, :3]
        jacobian = self.jacobian_hand_in_base(side, q)
        return np.vstack((rotation @ jacobian[:3], rotation @ jacobian[3:]))

    def pose_and_jacobian_local(self, side: Side, q: np.ndarray) -> tuple[pin.SE3, np.ndarray]:
        """Hand pose in `base` and Jacobian (6, 7) along the hand's own axes: one call for solvers."""
        arm, data, frame = self._arms[side]
        pin.computeJointJacobians(arm, data, q)  # also places the joints, which computeFrameJacobian does not
        return pin.updateFramePlacement(arm, data, frame), pin.getFrameJacobian(arm, data, frame, pin.LOCAL)

    def configuration(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        gripper_opening: np.ndarray | None = None,
    ) -> np.ndarray:
        """Joint vector (nq,) of the full model."""
        q = np.zeros(self.model.nq)
        q[self._base_index] = pose_base_in_map
        q[self._arm_index] = arm_positions
        q[self._head_index] = head_pan
        if gripper_opening is not None:
            q[self._finger_index] = np.asarray(gripper_opening)[:, None] / 2.0
        return q

    def link_poses(self, q: np.ndarray) -> dict[str, np.ndarray]:
        """Pose (4, 4) in the map of every link, for a joint vector of `configuration`."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return {name: self.data.oMf[n].homogeneous for name, n in self._link_frames.items()}

    def pose_camera_in_map(
        self, camera: str, pose_base_in_map: np.ndarray, arm_positions: np.ndarray, head_pan: float
    ) -> np.ndarray:
        """Optical frame (4, 4) of a camera: x right, y down, z forward.

        Raises:
            ValueError: no such camera.
        """
        if camera not in _CAMERA_FRAMES:
            raise ValueError(f"unknown camera {camera!r}; the robot has {', '.join(CAMERAS)}")
        q = self.configuration(pose_base_in_map, arm_positions, head_pan)
        pin.forwardKinematics(self.model, self.data, q)
        frame = self._link_frames[_CAMERA_FRAMES[camera]]
        return pin.updateFramePlacement(self.model, self.data, frame).homogeneous

    def gravity_torque(self, q: np.ndarray) -> np.ndarray:
        """Torque (2, 7) [N m] that holds the arms still against gravity, for a joint vector of `configuration`."""
        return pin.computeGeneralizedGravity(self.model, self.data, q)[self._arm_index]

    def inverse_dynamics(self, q: np.ndarray, arm_velocities: np.ndarray, arm_accelerations: np.ndarray) -> np.ndarray:
        """Torque (2, 7) [N m] of a motion of the arms (2, 7) [rad/s], [rad/s^2] with the base at rest."""
        velocity, acceleration = np.zeros(self.model.nv), np.zeros(self.model.nv)
        velocity[self._arm_index] = arm_velocities
        acceleration[self._arm_index] = arm_accelerations
        return pin.rnea(self.model, self.data, q, velocity, acceleration)[self._arm_index]


@lru_cache
def default_kinematics() -> Kinematics:
    """The one model of this process (building it takes a few milliseconds)."""
    return Kinematics()

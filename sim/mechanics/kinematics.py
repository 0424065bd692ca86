"""Where everything is: forward kinematics, Jacobians, limits and gravity of the robot, by pinocchio.

The arms are also kept as two models of their joints alone in the `base` frame: an inverse-kinematics step on one of
them costs a few microseconds in pinocchio, and the base pose is applied afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..extras import later
from ..world import SIDES, Side
from .planar import planar_pose
from .robot_model import RobotError, RobotModel

if TYPE_CHECKING:
    import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix
else:
    pin = later("pinocchio")


@dataclass(frozen=True, kw_only=True)
class ArmLimits:
    """Limits of the n joints of one arm, each (n,): [rad], [rad], [rad/s], [rad/s^2], [N m]."""

    lower: np.ndarray
    upper: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    effort: np.ndarray

    def clip(self, q: np.ndarray) -> np.ndarray:
        """Nearest allowed angles (n,) [rad]."""
        return np.clip(q, self.lower, self.upper)

    def margin(self, q: np.ndarray) -> float:
        """Least distance of an angle of `q` (n,) to its limit [rad]; below zero beyond it."""
        return float(np.min(np.minimum(q - self.lower, self.upper - q)))


class Kinematics:
    """The robot's kinematic and inertial model.

    Configurations are given as in an `Observation`: base pose (3,), arm angles (2, n) left then right, head
    pan and gripper openings (2,).  One instance is not safe to use from two threads.

    Args:
        robot: what it is made of.

    Attributes:
        robot: the same.
        limits: `ArmLimits` by side.
        head_range: lowest and highest head pan [rad].

    Raises:
        RobotError: the robot names joints or links that its description does not have, or that it cannot move.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.robot = robot
        self.model = pin.buildModelFromXML(robot.urdf())
        _check_names(robot, self.model)
        self.data = self.model.createData()
        full = self.model
        neutral = pin.neutral(full)
        self._arms: dict[Side, tuple[pin.Model, pin.Data, int]] = {}
        self._places_of_joints: dict[Side, np.ndarray] = {}  # (n, 3) of each arm where pinocchio keeps them [m]
        self.limits: dict[Side, ArmLimits] = {}
        self._arm_index = np.array(
            [[full.joints[full.getJointId(name)].idx_q for name in robot.joints_of(side)] for side in SIDES]
        )
        self._finger_index = np.array(
            [[full.joints[full.getJointId(name)].idx_q for name in robot.fingers[side]] for side in SIDES]
        )
        self._base_place = _place(np.array([full.joints[full.getJointId(name)].idx_q for name in robot.base_joints]))
        self._arm_places = [_place(index) for index in self._arm_index]
        self._head_index = full.joints[full.getJointId(robot.head_joint)].idx_q
        self.head_range = (
            float(full.lowerPositionLimit[self._head_index]),
            float(full.upperPositionLimit[self._head_index]),
        )
        for n, side in enumerate(SIDES):
            keep = set(robot.joints_of(side))
            locked = [full.getJointId(name) for name in full.names[1:] if name not in keep]
            arm = pin.buildReducedModel(full, locked, neutral)
            data = arm.createData()
            self._arms[side] = (arm, data, arm.getFrameId(robot.hands[side]))
            self._places_of_joints[side] = joint_places(data)[1:, 9:]
            index = self._arm_index[n]
            self.limits[side] = ArmLimits(
                lower=full.lowerPositionLimit[index].copy(),
                upper=full.upperPositionLimit[index].copy(),
                velocity=full.velocityLimit[index].copy(),
                acceleration=robot.limits.arm_acceleration.copy(),
                effort=full.effortLimit[index].copy(),
            )
        self._link_frames = {frame.name: n for n, frame in enumerate(full.frames) if frame.type == pin.FrameType.BODY}

    def pose_hand_in_base(self, side: Side, q: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of one hand for its n angles (n,) [rad]."""
        arm, data, frame = self._arms[side]
        pin.forwardKinematics(arm, data, np.asarray(q, float))
        return pin.updateFramePlacement(arm, data, frame).homogeneous

    def pose_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Pose (4, 4) of one hand for its n angles (n,) [rad] and a base pose (3,)."""
        return planar_pose(pose_base_in_map) @ self.pose_hand_in_base(side, q)

    def places_of_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Where `pose_hand_in_map` puts a hand for angles (k, n) [rad], (k, 3) [m]: in a third of the time."""
        arm, data, frame = self._arms[side]
        poses = np.empty((len(q), 4, 4))
        for n, angles in enumerate(np.asarray(q, float)):
            pin.forwardKinematics(arm, data, angles)
            poses[n] = pin.updateFramePlacement(arm, data, frame).homogeneous
        return (planar_pose(pose_base_in_map) @ poses)[:, :3, 3]

    def poses_hands_in_map(self, arm_positions: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Poses (2, 4, 4) of both hands for the angles of the arms (2, n) [rad] and a base pose (3,)."""
        base, poses = planar_pose(pose_base_in_map), np.empty((2, 4, 4))
        for n, side in enumerate(SIDES):
            poses[n] = base.dot(self.pose_hand_in_base(side, arm_positions[n]))  # as @, in half the time
        return poses

    def jacobian_hand_in_base(self, side: Side, q: np.ndarray) -> np.ndarray:
        """Jacobian (6, n) of the hand point: linear, then angular velocity, along the axes of `base`."""
        arm, data, frame = self._arms[side]
        return pin.computeFrameJacobian(arm, data, np.asarray(q, float), frame, pin.LOCAL_WORLD_ALIGNED)

    def velocities_of_hand_in_base(self, side: Side, q: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Velocities (k, 3) of a hand along the axes of `base` for angles (k, n) [rad] and rates (k, n) of them."""
        arm, data, frame = self._arms[side]
        jacobians = np.empty((len(q), 3, q.shape[1]))
        for n, angles in enumerate(np.asarray(q, float)):
            jacobians[n] = pin.computeFrameJacobian(arm, data, angles, frame, pin.LOCAL_WORLD_ALIGNED)[:3]
        return (jacobians @ rates[:, :, None])[:, :, 0]

    def jacobian_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """Jacobian (6, n) of the hand point along the axes of `map`."""
        rotation = planar_pose(pose_base_in_map)[:3, :3]
        jacobian = self.jacobian_hand_in_base(side, q)
        return np.vstack((rotation @ jacobian[:3], rotation @ jacobian[3:]))

    def pose_and_jacobian_local(self, side: Side, q: np.ndarray) -> tuple[pin.SE3, np.ndarray]:
        """Hand pose in `base` and Jacobian (6, n) along the hand's own axes: one call for solvers."""
        arm, data, frame = self._arms[side]
        pin.computeJointJacobians(arm, data, q)  # also places the joints, which computeFrameJacobian does not
        return pin.updateFramePlacement(arm, data, frame), pin.getFrameJacobian(arm, data, frame, pin.LOCAL)

    def hand_and_joints(self, side: Side, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Hand pose (4, 4) in `base`, Jacobian (6, n) along the hand's axes, places (n, 3) of the joints in `base`."""
        pose, jacobian = self.pose_and_jacobian_local(side, q)
        return pose.homogeneous, jacobian, self._places_of_joints[side].copy()

    def configuration(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        gripper_opening: np.ndarray | None = None,
    ) -> np.ndarray:
        """Joint vector (nq,) of the full model."""
        q = np.zeros(self.model.nq)
        q[self._base_place] = pose_base_in_map
        q[self._head_index] = head_pan
        if gripper_opening is not None:
            q[self._finger_index] = np.asarray(gripper_opening)[:, None] / 2.0
        q[self._arm_places[0]], q[self._arm_places[1]] = arm_positions
        return q

    def configurations(
        self,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        gripper_opening: np.ndarray | None = None,
    ) -> np.ndarray:
        """Joint vectors (k, nq) of `configuration` for postures (k, 2, n) of the arms, at least one, the rest alike."""
        first = self.configuration(pose_base_in_map, arm_positions[0], head_pan, gripper_opening)
        q = np.repeat(first[None], len(arm_positions), axis=0)
        for n, place in enumerate(self._arm_places):
            q[:, place] = arm_positions[:, n]
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
        if camera not in self.robot.cameras:
            raise ValueError(f"unknown camera {camera!r}; the robot has {', '.join(self.robot.cameras)}")
        q = self.configuration(pose_base_in_map, arm_positions, head_pan)
        pin.forwardKinematics(self.model, self.data, q)
        frame = self._link_frames[self.robot.cameras[camera]]
        return pin.updateFramePlacement(self.model, self.data, frame).homogeneous

    def gravity_torque(self, q: np.ndarray) -> np.ndarray:
        """Torque (2, n) [N m] that holds the arms still against gravity, for a joint vector of `configuration`."""
        return pin.computeGeneralizedGravity(self.model, self.data, q)[self._arm_index]

    def inverse_dynamics(self, q: np.ndarray, arm_velocities: np.ndarray, arm_accelerations: np.ndarray) -> np.ndarray:
        """Torque (2, n) [N m] of a motion of the arms (2, n) [rad/s], [rad/s^2] with the base at rest."""
        velocity, acceleration = np.zeros(self.model.nv), np.zeros(self.model.nv)
        velocity[self._arm_index] = arm_velocities
        acceleration[self._arm_index] = arm_accelerations
        return pin.rnea(self.model, self.data, q, velocity, acceleration)[self._arm_index]


def joint_places(data: pin.Data) -> np.ndarray:
    """(joints, 12) where pinocchio keeps the pose of every joint of a model: rotation by columns, then place.

    A view of its memory, which lives as long as `data` does: asking for the poses one by one would take ten times
    as long as computing them.
    """
    first = data.oMi[0].rotation[:1, 0]
    return np.lib.stride_tricks.as_strided(first, (len(data.oMi), 12), (12 * first.itemsize, first.itemsize))


def _place(index: np.ndarray) -> Any:
    """An index (n,) as a slice where its numbers follow each other: that is several times quicker."""
    return slice(index[0], index[-1] + 1) if (np.diff(index) == 1).all() else index


@lru_cache
def kinematics_of(robot: RobotModel) -> Kinematics:
    """The one model of a robot in this process (building it takes a few milliseconds)."""
    return Kinematics(robot)


def _check_names(robot: RobotModel, model: pin.Model) -> None:
    """Refuse a robot whose description lacks what it names: pinocchio would take the number behind the last one.

    Raises:
        RobotError: it does, or a joint turns without an end.
    """
    bodies = {frame.name for frame in model.frames if frame.type == pin.FrameType.BODY}
    links = {
        "hands": robot.hands.values(),
        "capsules": (capsule.link for capsule in robot.capsules),
        "own_pairs": (link for pair in robot.own_pairs for link in pair),
        "cameras": robot.cameras.values(),
    }
    for what, names in links.items():
        for name in names:
            if name not in bodies:
                raise RobotError(f"the description of {robot.name} has no link {name!r}, which its {what} name")
    joints = {
        "arm_joints": (joint for side in SIDES for joint in robot.joints_of(side)),
        "fingers": (joint for side in SIDES for joint in robot.fingers[side]),
        "base_joints": robot.base_joints,
        "head_joint": (robot.head_joint,),
    }
    for what, names in joints.items():
        for name in names:
            if not model.existJointName(name):
                raise RobotError(
                    f"the description of {robot.name} has no joint {name!r} that moves, which its {what} name"
                )
            if what == "arm_joints" and model.joints[model.getJointId(name)].nq != 1:
                raise RobotError(
                    f"the joint {name!r} of {robot.name} is continuous, but an end to each side is asked for"
                )

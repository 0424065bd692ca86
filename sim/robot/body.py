"""The robot as a body in a PyBullet world: loads the URDF, drives its motors, reads its joints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..bullet_client import pybullet
from ..mechanics.kinematics import Kinematics, kinematics_of
from ..mechanics.servo import PERIOD, Servo
from ..world import SIDES, Command, Side
from .baxter import BAXTER
from .urdf import urdf_path

# PyBullet lets two bodies collide when either one's group is in the other's mask, and every mask defaults to all:
# only a body in no group at all can choose what it touches.  Cloth and new rigid bodies are in group 1.
_NO_GROUP = 0

# What a motor may do beside carrying its arm, which Baxter does with springs on s1 and gravity compensation: what the
# hand may press with, at the joint's lever, and what its own motion takes, at most what the URDF rates it at.  That
# bounds what a hand that meets a person does, whatever is commanded; the guard stops a hand that carries an arm at a
# peak of 45 N.
_HAND_FORCE = 45.0  # [N]
_HEAD_TORQUE = 50.0  # [N m]
_BASE_FORCE = np.array((5000.0, 5000.0, 5000.0))
_POSITION_GAIN = 0.3  # share of a position error taken out per physics step, beside the velocity feed-forward
_CLOSED = 2e-3  # below this opening the fingertips touch [m]


@dataclass(frozen=True, kw_only=True)
class JointReading:
    """What the joint sensors say.

    Attributes:
        arm_positions: (2, n) [rad].
        arm_velocities: (2, n) [rad/s].
        motor_torques: (2, n) of the arms, beside what carries them (`RobotBody.efforts`) [N m].
        head_pan: [rad].
        pose_base_in_map: (3,) [m, m, rad], yaw within -pi and pi.
        twist_base: (3,) in the base frame [m/s, m/s, rad/s].
        gripper_opening: (2,) [m].
        gripper_force: (2,) squeezing force [N].
    """

    arm_positions: np.ndarray
    arm_velocities: np.ndarray
    motor_torques: np.ndarray
    head_pan: float
    pose_base_in_map: np.ndarray
    twist_base: np.ndarray
    gripper_opening: np.ndarray
    gripper_force: np.ndarray


class RobotBody:
    """The robot in an existing PyBullet client.

    Load it after the soft body, into a client without gravity: what its arms weigh is added to the efforts that are
    read.  Call `update(time)` before every physics step.  Its links are in their own
    collision group (none) and touch nothing until `set_collisions` says what; they never touch each other (the
    planner checks that beforehand, and resting contacts would push the arms).  To let the robot touch the person
    but not the cloth, put the person in group 2 and pass `collision_mask=2`.

    Args:
        client: a `pybullet_utils.bullet_client.BulletClient`, or the `pybullet` module itself.
        pose_base_in_map: (3,) where the base stands [m, m, rad].
        arm_positions: (2, n) posture to start in [rad]; the ready posture when omitted.
        head_pan: [rad].
        gripper_opening: of both hands; wide when omitted [m].
        collision_mask: PyBullet group bits that hands and arms collide with.
        time: the world's clock now [s].
        kinematics: of the robot; Baxter's when omitted.

    Attributes:
        body: PyBullet's id of the robot.
        links: link index by name, for anchors, contacts and rendering.
        servo: the controller and its targets.
    """

    def __init__(
        self,
        client: Any,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray | None = None,
        head_pan: float = 0.0,
        *,
        gripper_opening: float | None = None,
        collision_mask: int = 0,
        time: float = 0.0,
        kinematics: Kinematics | None = None,
    ) -> None:
        self._client = client
        self.kinematics = kinematics or kinematics_of(BAXTER)
        self._robot = robot = self.kinematics.robot
        arms = robot.ready if arm_positions is None else np.asarray(arm_positions, float)
        opening = robot.gripper.stroke if gripper_opening is None else gripper_opening
        self.servo = Servo(self.kinematics, pose_base_in_map, arms, head_pan, time)
        self.servo.gripper_opening = np.full(2, opening)
        self.body: int = client.loadURDF(str(urdf_path(robot)), useFixedBase=True)
        joint_of: dict[str, int] = {}
        self.links: dict[str, int] = {"map": -1}
        for index in range(client.getNumJoints(self.body)):
            info = client.getJointInfo(self.body, index)
            joint_of[info[1].decode()] = index
            self.links[info[12].decode()] = index
        fingers = (joint for side in SIDES for joint in robot.fingers[side])
        names = (*robot.base_joints, *robot.commanded_joints, *fingers)
        self._joints = [joint_of[name] for name in names]
        self._count = len(names)
        self._gains = [_POSITION_GAIN] * self._count
        self._velocity_gains = [1.0] * self._count
        self._arms = slice(3, 3 + 2 * robot.dof)  # of those; head and fingers come after them
        self._rated = np.array([self.kinematics.limits[side].effort for side in SIDES])
        self._forces = np.concatenate((_BASE_FORCE, self._rated.ravel(), (_HEAD_TORQUE,), np.zeros(4)))
        self._fingers = np.full(4, opening / 2)
        self._next_update = -np.inf
        self._reading: JointReading | None = None  # what `read` last said, as long as it holds
        self._carried: JointReading | None = None  # for which `_efforts` were computed last
        self._efforts = np.zeros((2, robot.dof))
        start = self._targets()[0]
        for joint, value in zip(self._joints, start, strict=True):
            client.resetJointState(self.body, joint, float(value))
        client.changeDynamics(self.body, -1, linearDamping=0.0, angularDamping=0.0)
        self.set_collisions(collision_mask)
        self._drive()

    def set_collisions(self, mask: int, links: tuple[str, ...] | None = None) -> None:
        """Choose what the robot collides with: bodies whose PyBullet group is in `mask` (0: nothing).

        Args:
            mask: bits of the groups to collide with; 1 is cloth and every body whose group was never set.
            links: only these links; all when omitted.

        Raises:
            KeyError: no such link.
        """
        for name in self.links if links is None else links:
            self._client.setCollisionFilterGroupMask(self.body, self.links[name], _NO_GROUP, mask)

    def command(self, command: Command) -> Command:
        """Start a command; returns it as clipped (see `Servo.command`)."""
        self._reading = None  # what the fingers feel depends on what they were told
        return self.servo.command(command)

    def move_joints(self, side: Side, velocities: np.ndarray, duration: float) -> None:
        """Move an arm's joints (n,) [rad/s] for `duration` [s] (see `Servo.move_joints`)."""
        self.servo.move_joints(side, velocities, duration)

    def stop(self) -> None:
        """End every motion now, braking at the acceleration limits; the grippers keep their opening."""
        self.servo.stop()

    def update(self, time: float) -> None:
        """Set the motors for the physics step that starts at `time` [s]; cheap between control periods."""
        if time + 1e-9 >= self._next_update:
            arms = self.read().arm_positions
            self._forces[self._arms] = self._torque_limits(arms).ravel()
            self.servo.keep_near(arms.ravel())
            self.servo.advance(time + PERIOD)
            self._next_update = time + PERIOD
            self._drive()
        self._reading = None

    def read(self) -> JointReading:
        """Joint positions, velocities and torques as the sensors see them; the same until the next `update`."""
        if self._reading is None:
            self._reading = self._read()
        return self._reading

    def _read(self) -> JointReading:
        # called at every step of the robot: numbers are taken as PyBullet gives them, and put into arrays at once
        q, dq, _, torque = zip(*self._client.getJointStates(self.body, self._joints), strict=True)
        arms = np.array((q, dq, torque))[:, self._arms].reshape(3, 2, -1)
        yaw = q[2]
        c, s = math.cos(yaw), math.sin(yaw)
        opening, squeeze = np.empty(2), np.empty(2)
        told, limit = self.servo.gripper_opening, self.servo.gripper_force_limit
        for n, one in enumerate((-4, -2)):
            other = one + 1
            opening[n] = apart = q[one] + q[other]
            # Each finger's motor pushes towards closed with minus its force.
            squeeze[n] = max(0.0, (torque[one] + torque[other]) / -2.0)
            # PyBullet's stop at zero opening carries nothing; a real gripper told to close squeezes its own fingertips.
            if apart < _CLOSED and told[n] < _CLOSED:
                squeeze[n] = limit[n]
        return JointReading(
            arm_positions=arms[0],
            arm_velocities=arms[1],
            motor_torques=arms[2],
            head_pan=q[self._arms.stop],
            pose_base_in_map=np.array((q[0], q[1], (yaw + np.pi) % (2 * np.pi) - np.pi)),
            twist_base=np.array((c * dq[0] + s * dq[1], c * dq[1] - s * dq[0], dq[2])),
            gripper_opening=opening,
            gripper_force=squeeze,
        )

    def efforts(self, reading: JointReading) -> np.ndarray:
        """(2, n) torque of the arms' motors, gravity included, where the joints are as in `reading` [N m]."""
        if self._carried is not reading:  # several look within one tick
            gravity = self.kinematics.gravity_torque(self.configuration(reading))
            self._carried, self._efforts = reading, reading.motor_torques + gravity
        return self._efforts.copy()

    def poses_hands_in_map(self, reading: JointReading | None = None) -> np.ndarray:
        """Poses (2, 4, 4) of both hands by forward kinematics of the measured joints."""
        reading = reading or self.read()
        return self.kinematics.poses_hands_in_map(reading.arm_positions, reading.pose_base_in_map)

    def pose_hand_in_map(self, side: Side, reading: JointReading | None = None) -> np.ndarray:
        """Pose (4, 4) of a hand by forward kinematics of the measured joints."""
        reading = reading or self.read()
        q = reading.arm_positions[SIDES.index(side)]
        return self.kinematics.pose_hand_in_map(side, q, reading.pose_base_in_map)

    def configuration(self, reading: JointReading | None = None) -> np.ndarray:
        """Joint vector (nq,) of the measured joints, for `Kinematics.link_poses`."""
        reading = reading or self.read()
        return self.kinematics.configuration(
            reading.pose_base_in_map, reading.arm_positions, reading.head_pan, reading.gripper_opening
        )

    def apply_hand_forces(self, forces_in_map: Mapping[Side, np.ndarray]) -> None:
        """Load hands between the fingertips with forces (3,) [N] for the next physics step."""
        links = [self.links[f"{side}_hand"] for side in forces_in_map]
        states = self._client.getLinkStates(self.body, links) if links else ()  # each call reads the whole robot
        for link, force, state in zip(links, forces_in_map.values(), states, strict=True):
            self._client.applyExternalForce(self.body, link, force.tolist(), state[4], pybullet.WORLD_FRAME)

    def push(self, link: str, force_in_map: np.ndarray, point_in_map: np.ndarray) -> None:
        """Load a link with a force (3,) [N] at a point (3,) [m] for the next physics step."""
        self._client.applyExternalForce(
            self.body, self.links[link], force_in_map.tolist(), point_in_map.tolist(), pybullet.WORLD_FRAME
        )

    def _torque_limits(self, arms: np.ndarray) -> np.ndarray:
        """(2, n) what each motor may do in a posture (2, n), beside carrying the arm [N m]."""
        moved = np.array(
            [self.kinematics.jacobian_hand_in_base(side, q)[:3] for side, q in zip(SIDES, arms, strict=True)]
        )
        levers = np.sqrt(np.add.reduce(moved * moved, axis=1))
        return np.minimum(self._rated, _HAND_FORCE * levers + self._robot.limits.motion_torque)

    def _targets(self) -> tuple[np.ndarray, np.ndarray]:
        """Motor targets of all joints and their rates, at the middle of the coming control period."""
        servo = self.servo
        c, s = math.cos(servo.pose_base_in_map[2]), math.sin(servo.pose_base_in_map[2])
        vx, vy, rate = servo.twist_base
        base_rate = np.array((c * vx - s * vy, s * vx + c * vy, rate))
        position = np.concatenate((servo.pose_base_in_map, servo.positions, self._fingers))
        velocity = np.concatenate((base_rate, servo.velocities, np.zeros(4)))
        return position - 0.5 * PERIOD * velocity, velocity

    def _drive(self) -> None:
        aim = (self.servo.gripper_opening / 2).repeat(2)
        step = self._robot.gripper.speed / 2 * PERIOD
        self._fingers = self._fingers + np.minimum(np.maximum(aim - self._fingers, -step), step)
        self._forces[-4:] = self.servo.gripper_force_limit.repeat(2)
        positions, velocities = self._targets()
        self._client.setJointMotorControlArray(
            self.body,
            self._joints,
            pybullet.POSITION_CONTROL,
            targetPositions=positions.tolist(),
            targetVelocities=velocities.tolist(),
            forces=self._forces.tolist(),
            positionGains=self._gains,
            velocityGains=self._velocity_gains,
        )

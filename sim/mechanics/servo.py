"""The low-level controller without physics: commands in, smooth joint and base targets out.

It knows the robot's limits and its own targets, nothing of the simulator, so the same motion comes out in
PyBullet, in a scripted world and in a test.  Call `advance` every `PERIOD` of the world's time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..world import SIDES, BaseVelocity, Command, GripperOpening, HandTwist, JointTrajectory, Side, WorldError
from .joint_limits import JointLimits
from .kinematics import Kinematics
from .twist import TwistTracker

PERIOD = 0.01  # [s]
_STILL = np.zeros(3)
MAX_LEAD = 0.05  # of a target before a joint that something stops: so far it moves on once it is free [rad]


@dataclass
class _Motion:
    """A timed motion of some commanded joints: samples every `PERIOD` from `start`."""

    start: float
    samples: np.ndarray  # (k, n)


class Servo:
    """Targets of the 2 n arm joints, the head, the base and the grippers.

    Attributes:
        positions: (2 n + 1,) joint targets, order `robot.commanded_joints` [rad].
        velocities: (2 n + 1,) their rates [rad/s].
        pose_base_in_map: (3,) base target [m, m, rad].
        twist_base: (3,) its rate in the base frame [m/s, m/s, rad/s].
        gripper_opening: (2,) wanted distance between the fingertips [m].
        gripper_force_limit: (2,) [N].
    """

    def __init__(
        self,
        kinematics: Kinematics,
        pose_base_in_map: np.ndarray,
        arm_positions: np.ndarray,
        head_pan: float = 0.0,
        time: float = 0.0,
    ) -> None:
        self._robot = robot = kinematics.robot
        self._moved = robot.limits
        self._dof = robot.dof
        count = 2 * robot.dof + 1
        limits = JointLimits.of(kinematics)
        self._lower, self._upper, self._speed = limits.lower, limits.upper, limits.velocity
        self._acceleration = np.concatenate(
            [*(kinematics.limits[side].acceleration for side in SIDES), (robot.limits.head_acceleration,)]
        )
        self.positions = np.clip(np.append(np.ravel(arm_positions), head_pan), self._lower, self._upper)
        self.velocities = np.zeros(count)
        self.pose_base_in_map = np.array(pose_base_in_map, float)
        self.twist_base = np.zeros(3)
        self.gripper_opening = np.full(2, robot.gripper.stroke)
        self.gripper_force_limit = np.full(2, 30.0)
        self._time = time
        self._owner: list[_Motion | None] = [None] * count
        self._column = np.zeros(count, int)  # where a joint stands in its motion's samples
        self._twists = {side: TwistTracker(kinematics, side) for side in SIDES}
        self._rates: dict[Side, tuple[np.ndarray, float]] = {}  # of an arm's joints, and until when
        self._base_wanted = np.zeros(3)
        self._base_until = -np.inf

    @property
    def moving(self) -> bool:
        """Whether anything but the grippers is still in motion."""
        return bool(
            np.abs(self.velocities).max() > 1e-4
            or np.abs(self.twist_base).max() > 1e-4
            or any(owner is not None for owner in self._owner)
        )

    def command(self, command: Command) -> Command:
        """Start a command, replacing what the same joints, hand or base were doing.

        Returns:
            The command as clipped to the limits.

        Raises:
            WorldError: no command of the contract.
        """
        if isinstance(command, JointTrajectory):
            return self._start_trajectory(command)
        if isinstance(command, HandTwist):
            side = SIDES.index(command.side)
            self._rates.pop(command.side, None)
            sent = self._twists[command.side].start(command, self._time)
            for joint in range(self._dof * side, self._dof * side + self._dof):
                self._owner[joint] = None
            return sent
        if isinstance(command, BaseVelocity):
            wanted = np.array(command.velocity, float)
            speed = math.hypot(*wanted[:2])
            wanted[:2] *= min(1.0, self._moved.base_velocity[0] / max(speed, 1e-9))
            wanted[2] = np.clip(wanted[2], -self._moved.base_velocity[1], self._moved.base_velocity[1])
            self._base_wanted, self._base_until = wanted, self._time + command.duration
            return BaseVelocity(velocity=wanted.copy(), duration=command.duration)
        if isinstance(command, GripperOpening):
            n = SIDES.index(command.side)
            self.gripper_opening[n] = np.clip(command.opening, 0.0, self._robot.gripper.stroke)
            self.gripper_force_limit[n] = np.clip(command.force_limit, *self._robot.gripper.force)
            return GripperOpening(
                side=command.side,
                opening=float(self.gripper_opening[n]),
                force_limit=float(self.gripper_force_limit[n]),
            )
        raise WorldError(
            f"the robot has no command {type(command).__name__}; it takes JointTrajectory, HandTwist, "
            "BaseVelocity and GripperOpening"
        )

    def move_joints(self, side: Side, velocities: np.ndarray, duration: float) -> None:
        """Move an arm's joints [rad/s] for `duration` [s], replacing what the arm was doing."""
        self._rates[side] = np.array(velocities, float), self._time + duration
        self._twists[side].cancel()
        first = self._dof * SIDES.index(side)
        for joint in range(first, first + self._dof):
            self._owner[joint] = None

    def stop(self) -> None:
        """End every motion: all targets brake at their acceleration limits.  The grippers keep their opening."""
        self._owner = [None] * len(self._owner)
        for twist in self._twists.values():
            twist.cancel()
        self._rates.clear()
        self._base_until = -np.inf

    def keep_near(self, arm_positions: np.ndarray) -> None:
        """Let the targets of the arms run ahead of the measured joints (2 n,) [rad] by no more than `MAX_LEAD`."""
        arms = self.positions[:-1]
        self.positions[:-1] = _within(arms, arm_positions - MAX_LEAD, arm_positions + MAX_LEAD)

    def advance(self, time: float) -> None:
        """Move the targets on to `time` [s]; nothing happens when less than `PERIOD` has passed."""
        while time - self._time >= PERIOD - 1e-9:
            self._time += PERIOD
            self._advance_base()
            self._advance_arms()

    def _advance_base(self) -> None:
        wanted = self._base_wanted if self._time <= self._base_until + 1e-9 else _STILL
        if not (wanted.any() or self.twist_base.any()):
            return
        change = wanted - self.twist_base
        length = math.hypot(*change[:2])
        change[:2] *= min(1.0, self._moved.base_acceleration[0] * PERIOD / max(length, 1e-12))
        turn = self._moved.base_acceleration[1] * PERIOD
        change[2] = min(max(change[2], -turn), turn)
        self.twist_base = self.twist_base + change
        yaw = self.pose_base_in_map[2] + 0.5 * self.twist_base[2] * PERIOD
        c, s = math.cos(yaw), math.sin(yaw)
        vx, vy, rate = self.twist_base
        self.pose_base_in_map = self.pose_base_in_map + PERIOD * np.array((c * vx - s * vy, s * vx + c * vy, rate))

    def _advance_arms(self) -> None:
        limit = self._acceleration * PERIOD
        wanted = self.velocities - _within(self.velocities, -limit, limit)  # brake, unless something drives the joint
        for joint, motion in enumerate(self._owner):
            if motion is None:
                continue
            n = round((self._time - motion.start) / PERIOD)
            last = len(motion.samples) - 1
            wanted[joint] = (motion.samples[min(n, last), self._column[joint]] - self.positions[joint]) / PERIOD
            if n >= last and abs(wanted[joint]) < 1e-6:
                self._owner[joint], wanted[joint] = None, 0.0
        for n, side in enumerate(SIDES):
            part = slice(self._dof * n, self._dof * (n + 1))
            rates = self._twists[side].rates(
                self._time, self.positions[part], self.velocities[part], self.pose_base_in_map, self.twist_base
            )
            if rates is not None:
                wanted[part] = rates
            driven = self._rates.get(side)
            if driven is not None and self._time <= driven[1] + 1e-9:
                wanted[part] = self.velocities[part] + _within(
                    driven[0] - self.velocities[part], -limit[part], limit[part]
                )
        wanted = _within(wanted, -self._speed, self._speed)
        target = _within(self.positions + wanted * PERIOD, self._lower, self._upper)
        self.velocities = (target - self.positions) / PERIOD
        self.positions = target

    def _start_trajectory(self, command: JointTrajectory) -> JointTrajectory:
        times, positions = np.asarray(command.times, float), np.asarray(command.positions, float)
        command.check_joints(self._robot)
        known = self._robot.commanded_joints
        index = np.array([known.index(name) for name in command.joints])
        positions = np.clip(positions, self._lower[index], self._upper[index])
        motion = _interpolate(times, positions)
        peak = float((np.abs(np.diff(motion, axis=0)) / PERIOD / self._speed[index]).max(initial=0.0))
        if peak > 1.001:  # too fast for a motor: the same path, slower
            times = times * peak
            motion = _interpolate(times, positions)
        entry = _Motion(start=self._time, samples=motion)
        for column, joint in enumerate(index):
            self._owner[joint] = entry
            self._column[joint] = column
            if joint < 2 * self._dof:
                self._twists[SIDES[joint // self._dof]].cancel()
                self._rates.pop(SIDES[joint // self._dof], None)
        return JointTrajectory(joints=command.joints, times=times, positions=positions)


def _within(values: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """As np.clip, which takes twice as long for a few numbers."""
    return np.minimum(np.maximum(values, low), high)


def _interpolate(times: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Samples every `PERIOD` (k, n), smooth and without overshoot, at rest at both ends."""
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    slopes = PchipInterpolator(times, positions).derivative()(times)
    slopes[0] = slopes[-1] = 0.0
    grid = np.append(np.arange(0.0, times[-1], PERIOD), times[-1])
    return CubicHermiteSpline(times, positions, slopes)(grid)

"""How far and how fast the commanded joints turn, and what becomes of a trajectory that asks for more."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..world import SIDES, JointTrajectory
from .kinematics import Kinematics
from .robot_model import RobotModel

ABOVE = 1.001  # share of a joint's speed that counts as too fast


@dataclass(frozen=True, kw_only=True, eq=False)
class JointLimits:
    """Limits of the m = 2 n + 1 joints that trajectories may name, in the order of `robot.commanded_joints`.

    Attributes:
        joints: (m,) their names.
        lower: (m,) [rad].
        upper: (m,) [rad].
        velocity: (m,) [rad/s].
    """

    joints: tuple[str, ...]
    lower: np.ndarray
    upper: np.ndarray
    velocity: np.ndarray

    @classmethod
    def of(cls, kinematics: Kinematics, head_velocity: float | None = None) -> JointLimits:
        """Those of a robot; `head_velocity` [rad/s] is its own by default."""
        robot, limits = kinematics.robot, [kinematics.limits[side] for side in SIDES]
        low, high = kinematics.head_range
        head = robot.limits.head_velocity if head_velocity is None else head_velocity
        return cls(
            joints=robot.commanded_joints,
            lower=np.concatenate([*(limit.lower for limit in limits), (low,)]),
            upper=np.concatenate([*(limit.upper for limit in limits), (high,)]),
            velocity=np.concatenate([*(limit.velocity for limit in limits), (head,)]),
        )

    @classmethod
    def none(cls, robot: RobotModel) -> JointLimits:
        """No limits, for a made-up arm."""
        infinite = np.full(len(robot.commanded_joints), np.inf)
        return cls(joints=robot.commanded_joints, lower=-infinite, upper=infinite, velocity=infinite)

    @property
    def unlimited(self) -> bool:
        """Whether there are none at all."""
        return bool(np.isinf(self.velocity).all())

    def of_arms(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Lower, upper [rad] and velocity [rad/s] of the arms' joints alone, each (2, n)."""
        lower, upper, velocity = (each[:-1].reshape(2, -1) for each in (self.lower, self.upper, self.velocity))
        return lower, upper, velocity

    def trajectory(self, command: JointTrajectory) -> tuple[JointTrajectory, np.ndarray]:
        """The same path within the limits, slower where it is too fast; and its speeds (k, m) at its points [rad/s].

        The joints have been checked: all of them are among `joints`.
        """
        index = [self.joints.index(name) for name in command.joints]
        positions = np.clip(np.asarray(command.positions, float), self.lower[index], self.upper[index])
        times = np.asarray(command.times, float)
        slopes = smooth_slopes(times, positions)
        peak = float((fastest_rates(times, positions, slopes) / self.velocity[index]).max(initial=0.0))
        if peak > ABOVE:
            times, slopes = times * peak, slopes / peak
        return replace(command, times=times, positions=positions), slopes


def smooth_slopes(times: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Speeds (k, m) at the points of a path (k, m), without overshoot and at rest at both ends [rad/s]."""
    from scipy.interpolate import PchipInterpolator

    slopes = np.zeros_like(positions)
    slopes[1:-1] = PchipInterpolator(times, positions).c[2, 1:]  # the spline in powers of the time since a point
    return slopes


def fastest_rates(times: np.ndarray, positions: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Greatest speeds (m,) on the way through points (k, m) [rad] with speeds (k, m) there [rad/s], cubic in between.

    The speed between two points is a parabola over the share s of the time that has passed: start + b s + a s^2.  It is
    greatest at an end or at the vertex.
    """
    start, end = slopes[:-1], slopes[1:]
    mean = np.diff(positions, axis=0) / np.diff(times)[:, None]
    a, b = 3.0 * (start + end - 2.0 * mean), 6.0 * mean - 4.0 * start - 2.0 * end
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = -b / (2.0 * a)
        there = np.where((vertex > 0.0) & (vertex < 1.0), start + 0.5 * b * vertex, 0.0)
    return np.maximum(np.abs(slopes).max(axis=0), np.abs(there).max(axis=0))

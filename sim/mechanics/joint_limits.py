"""How far and how fast the commanded joints turn, and what becomes of a trajectory that asks for more."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..world import SIDES, JointTrajectory
from .kinematics import Kinematics
from .robot_model import RobotModel

LOOKS = 20  # at the speed of a trajectory, between two of its points
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
        from scipy.interpolate import CubicHermiteSpline

        index = [self.joints.index(name) for name in command.joints]
        positions = np.clip(np.asarray(command.positions, float), self.lower[index], self.upper[index])
        times = np.asarray(command.times, float)
        slopes = smooth_slopes(times, positions)
        looks = np.interp(np.linspace(0, len(times) - 1, LOOKS * (len(times) - 1) + 1), np.arange(len(times)), times)
        rates = np.asarray(CubicHermiteSpline(times, positions, slopes).derivative()(looks))
        peak = float((np.abs(rates) / self.velocity[index]).max(initial=0.0))
        if peak > ABOVE:
            times, slopes = times * peak, slopes / peak
        return replace(command, times=times, positions=positions), slopes


def smooth_slopes(times: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Speeds (k, m) at the points of a path (k, m), without overshoot and at rest at both ends [rad/s]."""
    from scipy.interpolate import PchipInterpolator

    slopes = np.zeros_like(positions)
    slopes[1:-1] = PchipInterpolator(times, positions).c[2, 1:]  # the spline in powers of the time since a point
    return slopes

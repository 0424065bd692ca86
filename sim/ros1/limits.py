"""What is clipped before it is sent, and the slopes that make a trajectory smooth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator  # at once: no command may wait for it

from ..mechanics.kinematics import Kinematics
from ..robot.model import HEAD_JOINT, arm_joints
from ..world import SIDES, BaseVelocity, GripperOpening, JointTrajectory
from .site import Site

LOOKS = 20  # at the speed of a trajectory, between two of its points
ABOVE = 1.001  # share of a joint's speed that counts as too fast


class Clipping:
    """Brings commands within the limits of robot and site.

    Args:
        kinematics: knows the limits of the joints.
        site: those of grippers, head and base.
    """

    def __init__(self, kinematics: Kinematics, site: Site) -> None:
        self._site = site
        self._joints: dict[str, tuple[float, float, float]] = {}  # lower, upper [rad], speed [rad/s]
        for side in SIDES:
            limits = kinematics.limits[side]
            each = zip(limits.lower, limits.upper, limits.velocity, strict=True)
            self._joints |= dict(zip(arm_joints(side), each, strict=True))
        self._joints[HEAD_JOINT] = (*kinematics.head_range, site.head.speed)

    def trajectory(self, command: JointTrajectory) -> tuple[JointTrajectory, np.ndarray]:
        """The same path within the limits, slower where it is too fast; and its speeds (k, n) at its points."""
        low, high, speed = np.array([self._joints[name] for name in command.joints]).T
        positions = np.clip(np.asarray(command.positions, float), low, high)
        times = np.asarray(command.times, float)
        slopes = smooth_slopes(times, positions)
        looks = np.interp(np.linspace(0, len(times) - 1, LOOKS * (len(times) - 1) + 1), np.arange(len(times)), times)
        rates = np.asarray(CubicHermiteSpline(times, positions, slopes).derivative()(looks))
        peak = float((np.abs(rates) / speed).max(initial=0.0))
        if peak > ABOVE:
            times, slopes = times * peak, slopes / peak
        return replace(command, times=times, positions=positions), slopes

    def gripper(self, command: GripperOpening) -> GripperOpening:
        """Within stroke and force."""
        grip = self._site.grippers[command.side]
        force = float(np.clip(command.force_limit, *grip.force))
        return replace(command, opening=min(command.opening, grip.stroke), force_limit=force)

    def base(self, command: BaseVelocity) -> BaseVelocity:
        """The same direction, slower."""
        wanted, (speed, turn) = np.array(command.velocity, float), self._site.base.speed
        wanted[:2] *= min(1.0, speed / max(float(np.hypot(*wanted[:2])), 1e-9))
        wanted[2] = np.clip(wanted[2], -turn, turn)
        return replace(command, velocity=wanted)


def smooth_slopes(times: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Speeds (k, n) at the points of a path (k, n), without overshoot and at rest at both ends [rad/s]."""
    slopes = np.asarray(PchipInterpolator(times, positions).derivative()(times))
    slopes[0] = slopes[-1] = 0.0
    return slopes

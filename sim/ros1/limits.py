"""What is clipped before it is sent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.interpolate  # noqa: F401 at once: no command may wait for it

from ..mechanics.joint_limits import JointLimits
from ..mechanics.kinematics import Kinematics
from ..world import BaseVelocity, GripperOpening, JointTrajectory
from .site import Site


class Clipping:
    """Brings commands within the limits of robot and site.

    Args:
        kinematics: knows the limits of the joints.
        site: those of grippers, head and base.
    """

    def __init__(self, kinematics: Kinematics, site: Site) -> None:
        self._site = site
        self._joints = JointLimits.of(kinematics, head_velocity=site.head.speed)

    def trajectory(self, command: JointTrajectory) -> tuple[JointTrajectory, np.ndarray]:
        """The same path within the limits, slower where it is too fast; and its speeds (k, n) at its points."""
        return self._joints.trajectory(command)

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

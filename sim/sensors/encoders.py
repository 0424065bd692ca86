"""Joint sensors whose zero is off: what is read, what is commanded, and where the joints then are."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..robot.model import COMMANDED_JOINTS
from ..scene import difficulties
from ..world import JointTrajectory

if TYPE_CHECKING:
    from ..robot.body import JointReading


class Encoders:
    """The joints' sensors of one run.  The motors are controlled by them, so commands are off as much as readings.

    Args:
        rng: of this difficulty alone.
        sizes: how far off.
        joints: (m,) of two arms and the head, as trajectories name them; Baxter's by default.

    Attributes:
        offsets: (m,) reading less angle, in the order of `joints` [rad].
    """

    def __init__(
        self,
        rng: np.random.Generator,
        sizes: difficulties.Encoders = difficulties.SIZES.encoders,
        joints: tuple[str, ...] = COMMANDED_JOINTS,
    ) -> None:
        self._joints = joints
        self.offsets = sizes.offset * rng.uniform(-1.0, 1.0, len(joints))

    def measured(self, reading: JointReading) -> JointReading:
        """What is read of joints that stand as in `reading`."""
        return replace(
            reading,
            arm_positions=reading.arm_positions + self.offsets[:-1].reshape(2, -1),
            head_pan=reading.head_pan + float(self.offsets[-1]),
        )

    def angles(self, command: JointTrajectory) -> JointTrajectory:
        """A motion in readings as the motion of the joints that it makes."""
        return replace(command, positions=command.positions - self._of(command))

    def readings(self, command: JointTrajectory) -> JointTrajectory:
        """A motion of the joints as it is read."""
        return replace(command, positions=command.positions + self._of(command))

    def _of(self, command: JointTrajectory) -> np.ndarray:
        return self.offsets[[self._joints.index(name) for name in command.joints]]

"""Force sensors of the wrists: their bias, their tilt, and what they leave of the gripper's own weight."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from ..robot.model import FLANGE_TO_FINGERTIP
from ..scene import difficulties
from .camera_extrinsics import any_direction

GRAVITY = np.array((0.0, 0.0, -9.81))  # [m/s^2]
CENTRE = np.array((0.0, 0.0, -FLANGE_TO_FINGERTIP / 2))  # of the gripper's mass, in the frame of the hand [m]


@dataclass(frozen=True, kw_only=True)
class WristSensors:
    """The sensors of both wrists; without arguments they are exact but for the orientation that they are told.

    A sensor feels what pulls on the hand and the gripper's weight.  What is reported is that, less the weight that the
    gripper is taken to have, turned into the map by the hand's orientation as the joint sensors give it.

    Attributes:
        bias: (2, 6) of each sensor along its own axes [N], [N m].
        mass: of the gripper [kg].
        mass_taken: (2,) what it is taken to be [kg].
        centre_error: (2, 3) place of its centre of mass less where that is taken to be, in the frame of the hand [m].
        tilt: (2, 3, 3) turns what is felt along the hand's axes into the sensor's.
    """

    bias: np.ndarray = field(default_factory=lambda: np.zeros((2, 6)))
    mass: float = difficulties.SIZES.wrench_bias.tool_mass
    mass_taken: np.ndarray = field(default_factory=lambda: np.full(2, difficulties.SIZES.wrench_bias.tool_mass))
    centre_error: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    tilt: np.ndarray = field(default_factory=lambda: np.tile(np.eye(3), (2, 1, 1)))

    @classmethod
    def drawn(
        cls, rng: np.random.Generator, sizes: difficulties.WrenchBias = difficulties.SIZES.wrench_bias
    ) -> WristSensors:
        """Sensors that are off.

        Args:
            rng: of this difficulty alone.
            sizes: how far off.
        """
        return cls(
            bias=np.array([[*sizes.force * any_direction(rng), *sizes.torque * any_direction(rng)] for _ in range(2)]),
            mass=sizes.tool_mass,
            mass_taken=sizes.tool_mass * (1.0 + sizes.mass_error * rng.uniform(-1.0, 1.0, 2)),
            centre_error=sizes.centre_error * rng.uniform(-1.0, 1.0, (2, 3)),
            tilt=Rotation.from_rotvec(sizes.tilt * rng.uniform(-1.0, 1.0, (2, 3))).as_matrix(),
        )

    def measured(
        self, wrench_in_map: np.ndarray, poses_hand_in_map: np.ndarray, measured_poses: np.ndarray
    ) -> np.ndarray:
        """(2, 6) what is reported along the map's axes [N], [N m].

        Args:
            wrench_in_map: (2, 6) what really pulls on the hands [N], [N m].
            poses_hand_in_map: (2, 4, 4) of the hands.
            measured_poses: (2, 4, 4) the same, by the robot's own senses.
        """
        reported = np.empty((2, 6))
        for n in range(2):
            turn, taken = poses_hand_in_map[n, :3, :3], measured_poses[n, :3, :3]
            weight = turn.T @ (self.mass * GRAVITY)
            force = turn.T @ wrench_in_map[n, :3] + weight
            torque = turn.T @ wrench_in_map[n, 3:] + np.cross(CENTRE + self.centre_error[n], weight)
            weight_taken = taken.T @ (self.mass_taken[n] * GRAVITY)
            force = self.tilt[n] @ force + self.bias[n, :3] - weight_taken
            torque = self.tilt[n] @ torque + self.bias[n, 3:] - np.cross(CENTRE, weight_taken)
            reported[n] = *(taken @ force), *(taken @ torque)
        return reported

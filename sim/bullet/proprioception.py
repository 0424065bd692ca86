"""What the robot feels of itself: joints, hands and fingers, with the errors and the noise of its sensors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..robot.body import JointReading, RobotBody
from ..sensors.sensor_errors import SensorErrors
from ..world import Observation
from .contact import Contact
from .fingers import Fingers
from .grip import Grip

WRENCH_NOISE = np.repeat((0.05, 0.005), 3)  # (6,) standard deviation of the wrist sensors [N], [N m]


class Proprioception:
    """Joint sensors exact but for `SensorErrors`, wrist wrenches with noise.

    Args:
        grips: of the left and the right hand, whose loads the wrists feel.
        contact: between robot and person, which they feel too.
        fingers: that press on what they hold.
        errors: of the sensors.
        noise: of the wrists is drawn from it.
    """

    def __init__(
        self,
        grips: Sequence[Grip],
        contact: Contact,
        fingers: Fingers,
        errors: SensorErrors,
        noise: np.random.Generator,
    ) -> None:
        self._grips, self._contact, self._fingers = grips, contact, fingers
        self._errors, self._noise = errors, noise

    def observe(self, time: float, robot: RobotBody, reading: JointReading, hands: np.ndarray) -> Observation:
        """What is felt now.

        Args:
            time: world clock [s].
            robot: as it stands.
            reading: of its joints at the last step.
            hands: (2, 4, 4) their poses in the map at that reading.
        """
        stands = robot.read()
        told = self._errors.joints(stands, time)
        told_hands = hands.copy() if told is reading else robot.poses_hands_in_map(told)
        wrench = np.zeros((2, 6))
        for n in range(2):
            wrench[n, :3] = self._grips[n].load
        wrench += self._contact.wrench(hands)
        wrench += WRENCH_NOISE * self._noise.standard_normal((2, 6))
        wrench = self._errors.wrench(wrench, hands, told_hands, time)
        force = np.maximum(told.gripper_force, self._contact.squeeze(hands))
        return Observation(
            time=time,
            arm_positions=told.arm_positions.copy(),
            arm_velocities=told.arm_velocities.copy(),
            arm_efforts=robot.efforts(stands),
            head_pan=told.head_pan,
            pose_base_in_map=told.pose_base_in_map.copy(),
            twist_base=told.twist_base.copy(),
            gripper_opening=told.gripper_opening.copy(),
            gripper_force=self._fingers.felt(force),
            wrench_hand_in_map=wrench,
            pose_hand_in_map=told_hands,
        )

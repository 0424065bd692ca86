"""Drive to a waypoint of the map, bringing the arms into a posture on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.mechanics.kinematics import kinematics_of
from ..sim.world import JointTrajectory
from .control.base import BASE, drive_to
from .control.follow import follow
from .control.hands import collision_checker
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .motion.reach import plan_arms


class Navigate(Skill):
    """Plans a path on the occupancy map and follows it with the holonomic base; what the hands hold is carried along.

    It fails where there is no free path, or no way for the arms.
    """

    goal = Input(str | np.ndarray, unit="m, m, rad, map", doc="name of a waypoint, or pose (3,) of the base")
    speed = Input(float, unit="m/s", doc="of the base", default=BASE.speed)
    arms = Input(
        np.ndarray, unit="rad", doc="joint angles (2, n) to bring the arms to on the way, or None", default=None
    )
    hand_speed = Input(float, unit="m/s", doc="of the hands on that way, relative to the base", default=0.5)
    reasons = (Reason.PATH_BLOCKED, Reason.COMMAND_LOST, Reason.TIMEOUT, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Send the arms off, drive, then see that both have arrived."""
        self.note(f"drives to {self.goal}" if isinstance(self.goal, str) else "drives")
        arrives = self.now()
        if self.arms is not None:
            sent = self.world.send(self._arm_motion())
            assert isinstance(sent, JointTrajectory)
            arrives = self.now() + float(sent.times[-1])
        yield from drive_to(self, self.goal, speed=self.speed)
        if self.arms is not None:
            yield from self.wait(arrives - self.now())
            yield from follow(self, self._arm_motion())

    def _arm_motion(self) -> JointTrajectory:
        """From where the arms are now to where they should be."""
        seen = self.world.observe()
        return plan_arms(
            kinematics_of(self.world.robot),
            self.arms,
            seen.arm_positions,
            seen.pose_base_in_map,
            hand_speed=self.hand_speed,
            checker=collision_checker(self),
        )

"""Drive to a waypoint of the map, bringing the arms into a posture on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.robot.kinematics import default_kinematics
from ..sim.world import JointTrajectory
from .control.base import BASE, drive_to
from .control.follow import follow
from .control.hands import collision_checker
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .motion.reach import plan_arms


class Navigate(Skill):
    """Plans a path on the occupancy map and follows it with the holonomic base.

    Inputs: `goal`, a waypoint's name or a pose (3,) in the map [m, m, rad]; `speed` of the base [m/s]; `arms`,
    joint angles (2, 7) to bring the arms to on the way [rad], or None to keep them; `hand_speed` of that motion,
    relative to the base [m/s].  What the hands hold is carried along.
    """

    goal = Input(str | np.ndarray)
    speed = Input(float, default=BASE.speed)
    arms = Input(np.ndarray, default=None)
    hand_speed = Input(float, default=0.5)
    reasons = (Reason.PATH_BLOCKED, Reason.COMMAND_LOST, Reason.TIMEOUT, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Send the arms off, drive, then see that both have arrived."""
        self.note(f"drives to {self.goal}" if isinstance(self.goal, str) else "drives")
        arms, arrives = None, self.now()
        if self.arms is not None:
            seen = self.world.observe()
            arms = plan_arms(
                default_kinematics(),
                self.arms,
                seen.arm_positions,
                seen.pose_base_in_map,
                hand_speed=self.hand_speed,
                checker=collision_checker(self),
            )
            sent = self.world.send(arms)
            assert isinstance(sent, JointTrajectory)
            arrives = self.now() + float(sent.times[-1])
        yield from drive_to(self, self.goal, speed=self.speed)
        if arms is not None:
            yield from self.wait(arrives - self.now())
            seen = self.world.observe()
            last = plan_arms(
                default_kinematics(),
                self.arms,
                seen.arm_positions,
                seen.pose_base_in_map,
                hand_speed=self.hand_speed,
                checker=collision_checker(self),
            )
            yield from follow(self, last)

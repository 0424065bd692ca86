"""What arms and base were last told to do, and until when it moves them."""

from __future__ import annotations

import numpy as np

from ...sim.vector import length
from ...sim.world import SIDES, Clock, Observation, Side


class MotionsUnderWay:
    """Until when, and how fast, what has been sent moves the robot.

    Args:
        clock: of the world.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._until = -np.inf  # world clock until which anything moves [s]
        self._base_until, self._base_speed = -np.inf, np.zeros(2)  # along the floor [m/s], and turning [rad/s]
        self._arm_until = {side: -np.inf for side in SIDES}  # what the arm itself was last told to do
        self._arm_speed = {side: 0.0 for side in SIDES}

    def arm_moves(self, side: Side, speed: float, duration: float) -> None:
        """An arm is told to move its hand for `duration` [s] at up to `speed` [m/s]."""
        self._arm_until[side] = self._clock.now() + duration
        self._arm_speed[side] = speed

    def base_moves(self, velocity: np.ndarray, duration: float) -> None:
        """The base is told to move for `duration` [s] with a velocity (3,) [m/s, m/s, rad/s]."""
        self._base_until = self._clock.now() + duration
        self._base_speed = np.array((length(velocity[:2]), abs(velocity[2])))

    def begin(self) -> None:
        """What was told is about to begin."""
        self._until = max(self._base_until, *self._arm_until.values())

    def forget(self) -> None:
        """Everything has been stopped."""
        self._base_until = self._until = -np.inf
        self._arm_until = {side: -np.inf for side in SIDES}

    def cut_short(self, since: float) -> bool:
        """Take note of a stop that came after `since` [s]; whether it ended a motion, which it does once."""
        moving = since < self._until
        if moving:
            self._until = -np.inf
        return moving

    def arm_speed(self, side: Side) -> float:
        """Speed that an arm gives its hand now, the base at rest [m/s]."""
        return self._arm_speed[side] if self._clock.now() < self._arm_until[side] else 0.0

    def carried(self, side: Side, seen: Observation) -> float:
        """Speed that the moving base gives a hand now [m/s]."""
        if self._clock.now() >= self._base_until:
            return 0.0
        arm = seen.pose_hand_in_map[SIDES.index(side), :2, 3] - seen.pose_base_in_map[:2]
        return float(self._base_speed[0] + self._base_speed[1] * length(arm))

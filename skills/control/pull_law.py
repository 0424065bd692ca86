"""How fast and where to the gripper moves while it pulls a sleeve: first the force, then the way along the arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.image.cloud import unit
from ..geometry.arm_path import ArmPath


@dataclass(frozen=True, kw_only=True)
class PullLaw:
    """Constants of the pull, found on the simulated gowns.

    1 to 3 N is a sleeve that slides; 10 N stretch a hundredth of the gown's threads by half.

    Attributes:
        clearance: of the gripper off the arm's axis [m].
        look_ahead: distance along the arm of the place steered to [m].
        slow_from: load from which the pull slows down [N].
        stop_at: load at which it stands still and only gives way [N].
        yielding: speed of giving way for each newton above `slow_from` [m/s/N].
        steering: gain of the correction towards the path [1/s].
        turning: gain of turning the hand [1/s].
        turn_speed: greatest rate of turning [rad/s].
    """

    clearance: float = 0.09
    look_ahead: float = 0.04
    slow_from: float = 5.5
    stop_at: float = 9.0
    yielding: float = 0.006
    steering: float = 2.0
    turning: float = 1.5
    turn_speed: float = 0.6

    def ease(self, load: np.ndarray) -> float:
        """Share of the wanted speed under a load (3,) [N]: 1 below `slow_from`, 0 from `stop_at` on."""
        return float(np.clip((self.stop_at - np.linalg.norm(load)) / (self.stop_at - self.slow_from), 0.0, 1.0))

    def velocity(
        self, path: ArmPath, place: float, hand: np.ndarray, aside: float, speed: float, load: np.ndarray
    ) -> np.ndarray:
        """Velocity (3,) of the gripper [m/s].

        Args:
            path: of the arm now.
            place: of the gripper along it.
            hand: (3,) position of the gripper [m].
            aside: wanted offset across the arm [m].
            speed: along the arm when nothing pulls [m/s].
            load: (3,) force of the sleeve on the gripper [N].
        """
        across, along, off = path.frame(place).T
        ease = self.ease(load)
        wanted = path.point(place) + aside * across + self.clearance * off
        error = wanted - hand
        error -= (error @ along) * along
        travel = unit(path.point(path.moved(place, -self.look_ahead)) - path.point(place))
        velocity = ease * speed * travel
        correction = self.steering * error
        size = float(np.linalg.norm(correction))
        velocity = velocity + correction * min(1.0, 0.6 * speed / max(size, 1e-9))
        excess = float(np.linalg.norm(load)) - self.slow_from
        if excess > 0.0:
            velocity = velocity + self.yielding * excess * unit(load)
        return velocity

    def turn(self, wanted: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Angular velocity (3,) from one orientation (4, 4) to another [rad/s]."""
        from scipy.spatial.transform import Rotation

        rate = self.turning * Rotation.from_matrix(wanted[:3, :3] @ pose[:3, :3].T).as_rotvec()
        return rate * min(1.0, self.turn_speed / max(float(np.linalg.norm(rate)), 1e-9))

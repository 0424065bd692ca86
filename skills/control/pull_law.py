"""The velocity of a gripper that pulls a sleeve over an arm: first the force, then the way along the arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.image.cloud import unit
from ...sim.quantity import Quantities, quantity
from ..geometry.arm_path import ArmPath

_FOUND = "choice: found by trials on the simulated gowns"


@dataclass(frozen=True, kw_only=True)
class PullLaw(Quantities):
    """How fast and where to the gripper goes, by where it is and by how hard the sleeve pulls.

    1 to 3 N is a sleeve that slides; 10 N stretch a hundredth of the gown's threads by half.
    """

    clearance: float = quantity(0.09, "m", "of the gripper off the arm's axis", _FOUND)
    look_ahead: float = quantity(0.04, "m", "distance along the arm of the point that is steered to", _FOUND)
    slow_from: float = quantity(5.5, "N", "load from which the pull slows down", _FOUND)
    stop_at: float = quantity(9.0, "N", "load at which the gripper goes no farther and only yields", _FOUND)
    yielding: float = quantity(0.006, "m/s/N", "speed of yielding for each newton above `slow_from`", _FOUND)
    steering: float = quantity(2.0, "1/s", "gain of the correction towards the path", _FOUND)
    max_correction: float = quantity(
        0.6,
        "1",
        "greatest speed of that correction, as a share of the speed along the arm",
        "choice: below 1, so that the way along the arm prevails",
    )
    turning: float = quantity(1.5, "1/s", "gain of turning the hand", _FOUND)
    turn_speed: float = quantity(0.6, "rad/s", "greatest rate of turning the hand", _FOUND)

    def ease(self, load: np.ndarray) -> float:
        """Share of the wanted speed under a load (3,) [N]: 1 below `slow_from`, 0 from `stop_at` on."""
        return float(np.clip((self.stop_at - np.linalg.norm(load)) / (self.stop_at - self.slow_from), 0.0, 1.0))

    def velocity(
        self, path: ArmPath, coordinate: float, hand: np.ndarray, offset: float, speed: float, load: np.ndarray
    ) -> np.ndarray:
        """Velocity (3,) of the gripper [m/s].

        Args:
            path: of the arm now.
            coordinate: arm coordinate of the gripper: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.
            hand: (3,) position of the gripper [m].
            offset: wanted one across the arm, along the first axis of `ArmPath.frame` [m].
            speed: along the arm when nothing pulls [m/s].
            load: (3,) force of the sleeve on the gripper [N].
        """
        across, along, off = path.frame(coordinate).T
        ease = self.ease(load)
        wanted = path.point(coordinate) + offset * across + self.clearance * off
        error = wanted - hand
        error -= (error @ along) * along
        travel = unit(path.point(path.moved(coordinate, -self.look_ahead)) - path.point(coordinate))
        velocity = ease * speed * travel
        correction = self.steering * error
        size = float(np.linalg.norm(correction))
        velocity = velocity + correction * min(1.0, self.max_correction * speed / max(size, 1e-9))
        excess = float(np.linalg.norm(load)) - self.slow_from
        if excess > 0.0:
            velocity = velocity + self.yielding * excess * unit(load)
        return velocity

    def turn(self, wanted: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Angular velocity (3,) from one orientation (4, 4) to another [rad/s]."""
        from scipy.spatial.transform import Rotation

        rate = self.turning * Rotation.from_matrix(wanted[:3, :3] @ pose[:3, :3].T).as_rotvec()
        return rate * min(1.0, self.turn_speed / max(float(np.linalg.norm(rate)), 1e-9))

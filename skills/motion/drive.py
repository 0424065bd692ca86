"""Follow a path with the holonomic base: one `BaseVelocity` per tick, corrected by where the base is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.robot import model
from ...sim.world import BaseVelocity


@dataclass(frozen=True, kw_only=True)
class DriveTuning(Quantities):
    """Numbers of following a path with the base."""

    position_tolerance: float = quantity(
        0.02, "m", "from the end at which the base has arrived", "choice: hands reach poses planned from there"
    )
    yaw_tolerance: float = quantity(
        math.radians(2.0), "rad", "from the final heading at which it has arrived", "choice: 3 cm at the hands"
    )
    look_ahead: float = quantity(
        0.15, "m", "distance along the path of the point that is steered to", "choice: rounds corners by a few cm"
    )
    gain: float = quantity(1.6, "1/s", "of the approach to the end", "choice: settles without overshoot")
    turn_gain: float = quantity(1.6, "1/s", "of turning to the final heading", "choice: as that of the approach")
    search_ahead: float = quantity(
        0.4,
        "m",
        "distance along the path in which the nearest point is sought",
        "choice: over two look-aheads",
    )
    search_points: int = quantity(21, "1", "points of the path that are looked at for it", "choice: one every 2 cm")


DRIVE = DriveTuning()


class PathFollower:
    """Drives the base along corner points and turns it to its final heading on the way.

    Args:
        path: (k, 2) corner points in the map, as from `plan_path` [m].
        yaw: final heading [rad].
        speed: greatest speed [m/s].
        turn_from: distance to the end at which turning to `yaw` begins [m]; before that the heading is kept.
        tuning: numbers of the controller.

    Raises:
        ValueError: the path is not (k, 2).
    """

    def __init__(
        self,
        path: np.ndarray,
        yaw: float,
        *,
        speed: float = float(model.BASE_VELOCITY[0]),
        turn_from: float = np.inf,
        tuning: DriveTuning = DRIVE,
    ) -> None:
        self._tuning = tuning
        self._path = np.asarray(path, float)
        if self._path.ndim != 2 or self._path.shape[1] != 2 or len(self._path) < 1:
            raise ValueError(f"a path is corner points (k, 2), got {np.shape(path)}")
        steps = np.linalg.norm(np.diff(self._path, axis=0), axis=1)
        self._marks = np.append(0.0, np.cumsum(steps))  # distance along the path of each corner
        self._yaw, self._speed, self._turn_from = float(yaw), float(speed), turn_from
        self._progress = 0.0

    def done(self, pose_base_in_map: np.ndarray) -> bool:
        """Whether the base at a pose (3,) stands at the end, within the tolerances."""
        pose = np.asarray(pose_base_in_map, float)
        return bool(
            np.linalg.norm(self._path[-1] - pose[:2]) <= self._tuning.position_tolerance
            and abs(_wrap(self._yaw - pose[2])) <= self._tuning.yaw_tolerance
        )

    def command(self, pose_base_in_map: np.ndarray) -> BaseVelocity:
        """Velocity for the next moment, in the base frame, given the base's pose (3,) in the map [m, m, rad]."""
        x, y, yaw = np.asarray(pose_base_in_map, float)
        here = np.array((x, y))
        self._advance(here)
        left = self._marks[-1] - self._progress
        aim = self._point(self._progress + self._tuning.look_ahead)
        offset = aim - here
        distance = float(np.linalg.norm(offset))
        to_go = max(left, float(np.linalg.norm(self._path[-1] - here)))
        # Brake as half the acceleration limit allows, then settle exponentially.
        speed = min(self._speed, np.sqrt(model.BASE_ACCELERATION[0] * to_go), self._tuning.gain * to_go)
        velocity = offset / max(distance, 1e-9) * speed
        error = _wrap(self._yaw - yaw) if left <= self._turn_from else 0.0
        turn = np.clip(self._tuning.turn_gain * error, -model.BASE_VELOCITY[1], model.BASE_VELOCITY[1])
        c, s = np.cos(yaw), np.sin(yaw)
        return BaseVelocity(
            velocity=np.array((c * velocity[0] + s * velocity[1], c * velocity[1] - s * velocity[0], turn))
        )

    def _advance(self, here: np.ndarray) -> None:
        """Move the progress mark to the nearest point of the path ahead of it, never back."""
        farthest = min(self._progress + self._tuning.search_ahead, self._marks[-1])
        ahead = np.linspace(self._progress, farthest, self._tuning.search_points)
        distances = [float(np.linalg.norm(self._point(mark) - here)) for mark in ahead]
        self._progress = float(ahead[int(np.argmin(distances))])

    def _point(self, mark: float) -> np.ndarray:
        mark = min(mark, self._marks[-1])
        return np.array([np.interp(mark, self._marks, self._path[:, n]) for n in range(2)])


def _wrap(angle: float) -> float:
    return float((angle + np.pi) % (2 * np.pi) - np.pi)

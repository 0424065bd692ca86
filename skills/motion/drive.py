"""Follow a path with the holonomic base: one `BaseVelocity` per tick, corrected by where the base is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...sim.compiled import fma, njit
from ...sim.mechanics.robot_model import MotionLimits
from ...sim.quantity import Quantities, quantity
from ...sim.vector import length
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
        limits: of the robot's motion.
        speed: greatest speed, that of the robot by default [m/s].
        turn_from: distance to the end at which turning to `yaw` begins [m]; before that the heading is kept.
        tuning: numbers of the controller.

    Raises:
        ValueError: the path is not (k, 2).
    """

    def __init__(
        self,
        path: np.ndarray,
        yaw: float,
        limits: MotionLimits,
        *,
        speed: float | None = None,
        turn_from: float = np.inf,
        tuning: DriveTuning = DRIVE,
    ) -> None:
        self._tuning = tuning
        self._path = np.asarray(path, float)
        if self._path.ndim != 2 or self._path.shape[1] != 2 or len(self._path) < 1:
            raise ValueError(f"a path is corner points (k, 2), got {np.shape(path)}")
        steps = np.linalg.norm(np.diff(self._path, axis=0), axis=1)
        self._marks = np.append(0.0, np.cumsum(steps))  # distance along the path of each corner
        self._limits = limits
        self._speed = float(limits.base_velocity[0] if speed is None else speed)
        self._yaw, self._turn_from = float(yaw), turn_from
        self._progress = 0.0

    def done(self, pose_base_in_map: np.ndarray) -> bool:
        """Whether the base at a pose (3,) stands at the end, within the tolerances."""
        pose = np.asarray(pose_base_in_map, float)
        return bool(
            length(self._path[-1] - pose[:2]) <= self._tuning.position_tolerance
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
        distance = length(offset)
        to_go = max(left, length(self._path[-1] - here))
        # Brake as half the acceleration limit allows, then settle exponentially.
        speed = min(self._speed, math.sqrt(self._limits.base_acceleration[0] * to_go), self._tuning.gain * to_go)
        velocity = offset / max(distance, 1e-9) * speed
        error = _wrap(self._yaw - yaw) if left <= self._turn_from else 0.0
        fastest = float(self._limits.base_velocity[1])
        turn = min(max(self._tuning.turn_gain * error, -fastest), fastest)
        c, s = math.cos(yaw), math.sin(yaw)
        return BaseVelocity(
            velocity=np.array((c * velocity[0] + s * velocity[1], c * velocity[1] - s * velocity[0], turn))
        )

    def _advance(self, here: np.ndarray) -> None:
        """Move the progress mark to the nearest point of the path ahead of it, never back."""
        farthest = min(self._progress + self._tuning.search_ahead, self._marks[-1])
        self._progress = _nearest(
            self._path, self._marks, self._progress, float(farthest), self._tuning.search_points, here[0], here[1]
        )

    def _point(self, mark: float) -> np.ndarray:
        return np.array(_point(self._path, self._marks, mark))


@njit()
def _point(path: np.ndarray, marks: np.ndarray, mark: float) -> tuple[float, float]:
    """The point of a path (k, 2) at a distance along it, given that of each corner (k,) [m]."""
    last = len(marks) - 1
    if mark >= marks[last]:
        return path[last, 0], path[last, 1]
    n = 0
    while marks[n + 1] <= mark:
        n += 1
    over, step = mark - marks[n], marks[n + 1] - marks[n]
    x = (path[n + 1, 0] - path[n, 0]) / step * over + path[n, 0]
    y = (path[n + 1, 1] - path[n, 1]) / step * over + path[n, 1]
    return x, y


@njit()
def _nearest(path: np.ndarray, marks: np.ndarray, first: float, last: float, count: int, x: float, y: float) -> float:
    """Of `count` marks between two of them, the one whose point is nearest to (x, y) [m]."""
    step, best, nearest = (last - first) / (count - 1), np.inf, first
    for n in range(count):
        mark = last if n == count - 1 else n * step + first
        px, py = _point(path, marks, mark)
        apart = np.sqrt(fma(py - y, py - y, (px - x) * (px - x)))
        if apart < best:
            best, nearest = apart, mark
    return nearest


def _wrap(angle: float) -> float:
    return float((angle + np.pi) % (2 * np.pi) - np.pi)

"""A person's arm as a path for the hand that dresses it: points, directions and distances along it.

An arm coordinate says where along the arm: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.  Beyond 3 the path goes straight
on past the fingertip, in lengths of the hand; below 0 past the shoulder to the neck, in lengths of the upper arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...perception.estimates import ArmPosture
from ...perception.image.cloud import unit
from ...sim.compiled import njit
from ...sim.quantity import Quantities, quantity
from ...sim.vector import cross

UP = np.array((0.0, 0.0, 1.0))  # in the map
ELBOW = 1.0  # arm coordinate


@dataclass(frozen=True, kw_only=True)
class ArmPathTuning(Quantities):
    """Numbers of the path along an arm."""

    blend: float = quantity(
        0.35, "1", "share of a segment over which the direction turns at a joint", "choice: the hand turns evenly"
    )
    max_slope: float = quantity(
        0.9, "1", "sine of the steepest direction", "choice: a hand cannot be turned about a vertical arm"
    )
    search_from: float = quantity(
        -0.6, "1", "arm coordinate from which the nearest point is looked for", "choice: as far as the neck"
    )
    search_to: float = quantity(
        4.6, "1", "arm coordinate up to which it is looked for", "choice: beyond where a sleeve is presented"
    )
    search_window: float = quantity(
        0.6, "1", "arm coordinates to either side of a known one in which it is looked for", "choice: half a forearm"
    )
    search_step: float = quantity(
        0.01, "1", "spacing of the arm coordinates that are tried", "choice: 2 to 3 mm of an arm"
    )


ARM_PATH = ArmPathTuning()


class ArmPath:
    """Geometry of one arm at one instant.

    Args:
        points_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the path.

    Attributes:
        points: those, as an array.
        lengths: (3,) upper arm, forearm, hand [m].
    """

    def __init__(self, points_in_map: np.ndarray, *, tuning: ArmPathTuning = ARM_PATH) -> None:
        self._tuning = tuning
        self.points = np.asarray(points_in_map, float)
        steps = np.diff(self.points, axis=0)
        self.lengths = np.linalg.norm(steps, axis=1)
        self._directions = steps / self.lengths[:, None]

    @classmethod
    def of(cls, posture: ArmPosture) -> ArmPath:
        """The path of a posture."""
        return cls(posture.points_in_map)

    def point(self, coordinate: float) -> np.ndarray:
        """(3,) point of the arm's axis [m]."""
        segment = _segment(coordinate)
        return self.points[segment] + (coordinate - segment) * self.lengths[segment] * self._directions[segment]

    def at(self, coordinates: np.ndarray) -> np.ndarray:
        """(n, 3) points of the arm's axis [m], as `point` gives them."""
        segments = np.minimum(np.maximum(np.floor(coordinates), 0), 2).astype(int)
        along = (coordinates - segments) * self.lengths[segments]
        return self.points[segments] + along[:, None] * self._directions[segments]

    def direction(self, coordinate: float) -> np.ndarray:
        """(3,) unit vector towards the fingertip, turning evenly near the joints."""
        segment, rest = _segment(coordinate), coordinate - _segment(coordinate)
        here, blend = self._directions[segment], self._tuning.blend
        if rest < blend and segment > 0:
            return unit(here + (0.5 - 0.5 * rest / blend) * (self._directions[segment - 1] - here))
        if rest > 1.0 - blend and segment < 2:
            return unit(here + (0.5 - 0.5 * (1.0 - rest) / blend) * (self._directions[segment + 1] - here))
        return here

    @property
    def hand_direction(self) -> np.ndarray:
        """(3,) unit vector from the wrist to the fingertip."""
        return self._directions[2]

    def frame(self, coordinate: float) -> np.ndarray:
        """(3, 3) columns: across the arm (horizontal), along it towards the fingertip, and off it (upwards)."""
        along, slope = self.direction(coordinate), self._tuning.max_slope
        if abs(along[2]) > slope:  # keep the heading of a steep arm defined
            flat = unit(along * (1.0, 1.0, 0.0) + 1e-6 * self._directions[0])
            along = unit(flat * np.sqrt(1.0 - slope**2) + np.sign(along[2]) * slope * UP)
        across = unit(cross(along, UP))
        return np.column_stack((across, along, cross(across, along)))

    def coordinate_of(self, point_in_map: np.ndarray, near: float | None = None) -> float:
        """The arm coordinate nearest to a point (3,) [m], looked for only around `near` where that is given."""
        tuning = self._tuning
        if near is None:
            low, high = tuning.search_from, tuning.search_to
        else:
            low, high = near - tuning.search_window, near + tuning.search_window
        count = int((high - low) / tuning.search_step) + 1
        return _nearest(self.points, self.lengths, self._directions, low, high, count, np.asarray(point_in_map, float))

    def moved(self, coordinate: float, distance: float) -> float:
        """The arm coordinate `distance` [m] further towards the fingertip (negative: towards the shoulder)."""
        left = distance
        while abs(left) > 1e-9:
            segment = _segment(coordinate if left > 0 else coordinate - 1e-9)
            if left > 0:
                room = (segment + 1 - coordinate) * self.lengths[segment] if segment < 2 else np.inf
            else:
                room = (coordinate - segment) * self.lengths[segment] if segment > 0 else np.inf
            step = min(abs(left), float(room))
            coordinate += np.sign(left) * step / self.lengths[segment]
            left -= np.sign(left) * step
        return float(coordinate)

    def distance(self, start: float, end: float) -> float:
        """Length of the path between two arm coordinates [m]."""
        low, high = sorted((start, end))
        total = 0.0
        for segment in range(3):
            first = low if segment == 0 else max(low, segment)
            last = high if segment == 2 else min(high, segment + 1)
            total += max(0.0, last - first) * float(self.lengths[segment])
        return total

    @property
    def bend(self) -> float:
        """Angle of the elbow, 0 for a straight arm [rad]."""
        return math.acos(np.clip(self._directions[0] @ self._directions[1], -1.0, 1.0))

    @property
    def pitch(self) -> float:
        """Angle of the whole arm above the horizontal, shoulder to fingertip [rad]."""
        whole = self.points[3] - self.points[0]
        return math.asin(whole[2] / np.linalg.norm(whole))


def _segment(coordinate: float) -> int:
    """Index of the segment that a coordinate belongs to: 0 upper arm, 1 forearm, 2 hand."""
    return min(max(math.floor(coordinate), 0), 2)


@njit()
def _nearest(
    points: np.ndarray,
    lengths: np.ndarray,
    directions: np.ndarray,
    low: float,
    high: float,
    count: int,
    place: np.ndarray,
) -> float:
    """Of `count` arm coordinates, evenly from `low` to `high`, the one at which the axis is nearest to a place (3,)."""
    best, least = low, np.inf
    for n in range(count):
        coordinate = high if n == count - 1 else n * ((high - low) / (count - 1)) + low
        segment = int(min(max(np.floor(coordinate), 0.0), 2.0))
        along, square = (coordinate - segment) * lengths[segment], 0.0
        for k in range(3):
            square += (points[segment, k] + along * directions[segment, k] - place[k]) ** 2
        if square < least:
            best, least = coordinate, square
    return best

"""A person's arm as a path for the hand that dresses it: places, directions and distances along it.

A place is a number: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.  Beyond 3 the path goes straight on past the
fingertip, below 0 past the shoulder towards the neck, both counted in lengths of the hand and the upper arm.
"""

from __future__ import annotations

import numpy as np

from ...perception.estimates import ArmPosture
from ...perception.image.cloud import unit

UP = np.array((0.0, 0.0, 1.0))
_BLEND = 0.35  # share of a segment over which directions change at a joint
_STEEPEST = 0.9  # sine of the steepest direction: a hand cannot be turned about a vertical arm


class ArmPath:
    """Geometry of one arm at one instant.

    Args:
        points_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
    """

    def __init__(self, points_in_map: np.ndarray) -> None:
        self.points = np.asarray(points_in_map, float)
        steps = np.diff(self.points, axis=0)
        self.lengths = np.linalg.norm(steps, axis=1)  # (3,) upper arm, forearm, hand [m]
        self._directions = steps / self.lengths[:, None]

    @classmethod
    def of(cls, posture: ArmPosture) -> ArmPath:
        """The path of a posture."""
        return cls(posture.points_in_map)

    def point(self, place: float) -> np.ndarray:
        """(3,) point of the arm's axis [m]."""
        segment = _segment(place)
        return self.points[segment] + (place - segment) * self.lengths[segment] * self._directions[segment]

    def direction(self, place: float) -> np.ndarray:
        """(3,) unit vector towards the fingertip, turning evenly near the joints."""
        segment, rest = _segment(place), place - _segment(place)
        here = self._directions[segment]
        if rest < _BLEND and segment > 0:
            return unit(here + (0.5 - 0.5 * rest / _BLEND) * (self._directions[segment - 1] - here))
        if rest > 1.0 - _BLEND and segment < 2:
            return unit(here + (0.5 - 0.5 * (1.0 - rest) / _BLEND) * (self._directions[segment + 1] - here))
        return here

    def frame(self, place: float) -> np.ndarray:
        """(3, 3) columns: across the arm (horizontal), along it towards the fingertip, and off it (upwards)."""
        along = self.direction(place)
        if abs(along[2]) > _STEEPEST:  # keep the heading of a steep arm defined
            flat = unit(along * (1.0, 1.0, 0.0) + 1e-6 * self._directions[0])
            along = unit(flat * np.sqrt(1.0 - _STEEPEST**2) + np.sign(along[2]) * _STEEPEST * UP)
        across = unit(np.cross(along, UP))
        return np.column_stack((across, along, np.cross(across, along)))

    def place_of(self, point_in_map: np.ndarray, near: float | None = None, window: float = 0.6) -> float:
        """The place nearest to a point, looked for within `window` of `near` when given."""
        low, high = (-0.6, 4.6) if near is None else (near - window, near + window)
        places = np.linspace(low, high, int((high - low) / 0.01) + 1)
        points = np.array([self.point(float(place)) for place in places])
        return float(places[int(np.argmin(np.linalg.norm(points - point_in_map, axis=1)))])

    def moved(self, place: float, distance: float) -> float:
        """The place `distance` [m] further towards the fingertip (negative: towards the shoulder)."""
        left = distance
        while abs(left) > 1e-9:
            segment = _segment(place if left > 0 else place - 1e-9)
            if left > 0:
                room = (segment + 1 - place) * self.lengths[segment] if segment < 2 else np.inf
            else:
                room = (place - segment) * self.lengths[segment] if segment > 0 else np.inf
            step = min(abs(left), float(room))
            place += np.sign(left) * step / self.lengths[segment]
            left -= np.sign(left) * step
        return float(place)

    def distance(self, start: float, end: float) -> float:
        """Length of the path between two places [m]."""
        low, high = sorted((start, end))
        total = 0.0
        for segment in range(3):
            first = low if segment == 0 else max(low, segment)
            last = high if segment == 2 else min(high, segment + 1)
            total += max(0.0, last - first) * float(self.lengths[segment])
        return total

    @property
    def pitch(self) -> float:
        """Angle of the whole arm above the horizontal, shoulder to fingertip [rad]."""
        whole = self.points[3] - self.points[0]
        return float(np.arcsin(whole[2] / np.linalg.norm(whole)))


def _segment(place: float) -> int:
    return int(np.clip(np.floor(place), 0, 2))

"""A base that knows roughly where it stands in the map, and less and less the same."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..scene import difficulties
from ..world import HandTwist


class Localisation:
    """The error of the base's pose as a random walk of x, y and yaw between two bounds each, where it turns back.

    It depends on the time alone, not on how often it is asked for.  Whatever the robot puts into the map by its base
    (hands, cameras, what these see) is off by the same error, and so are velocities in the map that it is told.

    Args:
        rng: of this difficulty alone.
        sizes: how far off, and how fast that changes.
    """

    def __init__(
        self, rng: np.random.Generator, sizes: difficulties.Localisation = difficulties.SIZES.localisation
    ) -> None:
        self._rng, self._period = rng, sizes.period
        self._bounds = np.array((sizes.position, sizes.position, sizes.turn))
        self._steps = np.sqrt(sizes.period) * np.array((sizes.position_drift, sizes.position_drift, sizes.turn_drift))
        self._walk = [self._bounds * rng.uniform(-1.0, 1.0, 3)]

    def error(self, time: float) -> np.ndarray:
        """(3,) pose as localised less pose: x [m], y [m], yaw [rad] at `time` [s], not negative."""
        whole = int(time / self._period)
        while len(self._walk) < whole + 2:
            self._walk.append(_reflected(self._walk[-1] + self._steps * self._rng.standard_normal(3), self._bounds))
        share = time / self._period - whole
        return (1.0 - share) * self._walk[whole] + share * self._walk[whole + 1]

    def measured(self, pose_base_in_map: np.ndarray, time: float) -> np.ndarray:
        """(3,) pose as localised at `time` of a base that stands at `pose_base_in_map` (3,) [m, m, rad]."""
        x, y, yaw = pose_base_in_map + self.error(time)
        return np.array((x, y, (yaw + np.pi) % (2 * np.pi) - np.pi))

    def executed(self, command: HandTwist, time: float) -> HandTwist:
        """A twist along the map's axes as the robot takes them to be, as the twist that it makes."""
        return _turned(command, -float(self.error(time)[2]))

    def told(self, command: HandTwist, time: float) -> HandTwist:
        """A twist that the robot makes, along the map's axes as it takes them to be."""
        return _turned(command, float(self.error(time)[2]))


def _reflected(values: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """`values` folded back into -bounds to bounds; they are beyond by less than twice that."""
    return np.where(np.abs(values) > bounds, np.sign(values) * 2 * bounds - values, values)


def _turned(command: HandTwist, yaw: float) -> HandTwist:
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    return replace(command, twist_in_map=(command.twist_in_map.reshape(2, 3) @ turn.T).ravel())

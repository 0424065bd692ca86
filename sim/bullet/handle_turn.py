"""Where the motors of a handle go for a pose of its hand, compiled: both hands ask before every step of the room."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import fma, njit

_ROUND = 2 * math.pi  # [rad]


@njit()
def motor_targets(pose_in_map: np.ndarray, turn_at_reset: np.ndarray, last: np.ndarray) -> np.ndarray:
    """(6,) place [m] and angles about z, the new y and the new x [rad] of a pose, without a jump from the last angles.

    A jump would spin the cloth round: of all angles that make the same turn, those nearest to the last ones count.

    Args:
        pose_in_map: (4, 4) of the hand.
        turn_at_reset: (3, 3) of the hand where the angles are zero.
        last: (6,) targets before.
    """
    target = np.empty(6)
    for k in range(3):
        target[k] = pose_in_map[k, 3]
    R = np.empty((3, 3))  # since the reset
    for i in range(3):
        for j in range(3):
            R[i, j] = fma(
                pose_in_map[i, 2],
                turn_at_reset[j, 2],
                fma(pose_in_map[i, 1], turn_at_reset[j, 1], pose_in_map[i, 0] * turn_at_reset[j, 0]),
            )
    y = math.asin(min(1.0, max(-1.0, -R[2, 0])))
    z, x = math.atan2(R[1, 0], R[0, 0]), math.atan2(R[2, 1], R[2, 2])
    target[3], target[4], target[5] = z, y, x
    if max(abs(z - last[3]), abs(y - last[4]), abs(x - last[5])) < math.pi / 2:
        return target  # any other way to the same turn is further off
    least = math.inf
    for way in ((z, y, x), (z + math.pi, math.pi - y, x + math.pi)):
        apart = 0.0
        for k in range(3):
            apart = max(apart, abs(_near(way[k], last[3 + k]) - last[3 + k]))
        if apart < least:
            least = apart
            for k in range(3):
                target[3 + k] = _near(way[k], last[3 + k])
    return target


@njit(inline="always")
def _near(angle: float, last: float) -> float:
    """The angle that makes the same turn and is nearest to the last one."""
    return angle + _ROUND * round((last - angle) / _ROUND)

"""Rotations as vectors (3,): along the axis, as long as the angle [rad].  For compiled loops; arrays come back new."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import njit


@njit(inline="always")
def rotation(vector: np.ndarray) -> np.ndarray:
    """Rotation matrix (3, 3) of a vector (3,)."""
    x, y, z = vector[0], vector[1], vector[2]
    angle = math.sqrt(x * x + y * y + z * z)
    half = 0.5 * angle
    sinc = math.sin(half) / half if half > 1e-8 else 1.0
    a = sinc * math.cos(half)  # sin(angle) / angle
    b = 0.5 * sinc * sinc  # (1 - cos(angle)) / angle ** 2
    result = np.empty((3, 3))
    result[0, 0], result[0, 1], result[0, 2] = 1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    result[1, 0], result[1, 1], result[1, 2] = b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x
    result[2, 0], result[2, 1], result[2, 2] = b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)
    return result


@njit(inline="always")
def rotation_vector(R: np.ndarray) -> np.ndarray:
    """Vector (3,) of a rotation matrix (3, 3), no longer than pi: by way of the quaternion, exact at any angle."""
    w = 1.0 + R[0, 0] + R[1, 1] + R[2, 2]  # 4 times the square of the real part
    vector = np.empty(3)
    if w > 1.0:
        vector[0], vector[1], vector[2] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
        vector /= 2.0 * math.sqrt(w)
        real = 0.5 * math.sqrt(w)
    else:  # near half a turn the largest part of the axis is told best
        i = 0 if R[0, 0] >= R[1, 1] and R[0, 0] >= R[2, 2] else (1 if R[1, 1] >= R[2, 2] else 2)
        j, k = (i + 1) % 3, (i + 2) % 3
        part = math.sqrt(1.0 + R[i, i] - R[j, j] - R[k, k])
        vector[i], vector[j], vector[k] = 0.5 * part, 0.5 * (R[i, j] + R[j, i]) / part, 0.5 * (R[i, k] + R[k, i]) / part
        real = 0.5 * (R[k, j] - R[j, k]) / part
        if real < 0.0:
            vector, real = -vector, -real
    half = math.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)  # sine of half the angle
    if half < 1e-12:
        return 2.0 * vector
    return vector * (2.0 * math.atan2(half, real) / half)

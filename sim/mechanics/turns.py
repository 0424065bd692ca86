"""Turns as vectors (3,) along their axis, as long as the angle [rad], and as matrices: scipy's to the last bit.

Loading scipy's own takes as long as tens of thousands of turns.
"""

from __future__ import annotations

import math

import numpy as np

_SMALL = 1e-3  # [rad] turns that are smaller are told by series


def turn_matrix(vector: np.ndarray) -> np.ndarray:
    """Rotation matrix (3, 3) of a vector (3,), as `Rotation.from_rotvec(vector).as_matrix()`."""
    x, y, z = vector.tolist()
    angle = math.sqrt(x * x + y * y + z * z)
    square = angle * angle
    scale = 0.5 - square / 48 + square * square / 3840 if angle <= _SMALL else math.sin(angle / 2) / angle
    x, y, z, w = scale * x, scale * y, scale * z, math.cos(angle / 2)
    x2, y2, z2, w2 = x * x, y * y, z * z, w * w
    xy, zw, xz, yw, yz, xw = x * y, z * w, x * z, y * w, y * z, x * w
    return np.array(
        (
            (x2 - y2 - z2 + w2, 2 * (xy - zw), 2 * (xz + yw)),
            (2 * (xy + zw), -x2 + y2 - z2 + w2, 2 * (yz - xw)),
            (2 * (xz - yw), 2 * (yz + xw), -x2 - y2 + z2 + w2),
        )
    )


def turn_vector(matrix: np.ndarray) -> np.ndarray:
    """Vector (3,) of a rotation matrix (3, 3), as `Rotation.from_matrix(matrix).as_rotvec()`."""
    x, y, z, w = _quaternion(matrix.tolist())
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    angle = 2 * math.atan2(math.sqrt(x * x + y * y + z * z), w)
    square = angle * angle
    scale = 2 + square / 12 + 7 * square * square / 2880 if angle <= _SMALL else angle / math.sin(angle / 2)
    return np.array((scale * x, scale * y, scale * z))


def _quaternion(r: list[list[float]]) -> tuple[float, float, float, float]:
    """Parts x, y, z, w, of which the largest is found first: by it the others are told best."""
    trace = r[0][0] + r[1][1] + r[2][2]
    parts = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], 1 + trace]
    choices = (r[0][0], r[1][1], r[2][2], trace)
    if (i := choices.index(max(choices))) < 3:
        j, k = (i + 1) % 3, (i + 2) % 3
        parts[3] = parts[i]
        parts[i], parts[j], parts[k] = 1 - trace + 2 * r[i][i], r[j][i] + r[i][j], r[k][i] + r[i][k]
    x, y, z, w = parts
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    return x / norm, y / norm, z / norm, w / norm

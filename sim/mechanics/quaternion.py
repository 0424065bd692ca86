"""Poses as they are recorded: place and quaternion."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import njit


@njit()
def places(poses: np.ndarray) -> np.ndarray:
    """(k, 7) position and quaternion x, y, z, w of poses (k, 4, 4), as scipy's `Rotation.as_quat` gives it."""
    out = np.empty((len(poses), 7))
    for n in range(len(poses)):
        R = poses[n]
        out[n, :3] = R[:3, 3]
        trace = R[0, 0] + R[1, 1] + R[2, 2]
        i = 0  # the largest part, by which the others are told best
        for k in (1, 2):
            if R[k, k] > R[i, i]:
                i = k
        if trace > R[i, i]:
            parts = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1.0 + trace)
            for k in range(4):
                out[n, 3 + k] = parts[k]
        else:
            j, k = (i + 1) % 3, (i + 2) % 3
            out[n, 3 + i] = 1.0 - trace + 2.0 * R[i, i]
            out[n, 3 + j] = R[j, i] + R[i, j]
            out[n, 3 + k] = R[k, i] + R[i, k]
            out[n, 6] = R[k, j] - R[j, k]
        out[n, 3:] /= math.sqrt(out[n, 3] ** 2 + out[n, 4] ** 2 + out[n, 5] ** 2 + out[n, 6] ** 2)
    return out

"""Small vectors, of which a tick measures hundreds: numpy's general functions cost ten times what the sum does."""

from __future__ import annotations

import math

import numpy as np


def length(vector: np.ndarray) -> float:
    """Euclidean length of one vector (n,) of floats; `np.linalg.norm` to the last bit."""
    return math.sqrt(vector.dot(vector))


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Vector product (3,) of two vectors (3,) of floats; `np.cross` to the last bit."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))

"""Poses of a base on the floor."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np


def planar_pose(pose_base_in_map: np.ndarray) -> np.ndarray:
    """Transform (4, 4) of a base pose (x [m], y [m], yaw [rad]); read-only."""
    return _kept(*np.asarray(pose_base_in_map, float).tolist())


@lru_cache(maxsize=16)
def _kept(x: float, y: float, yaw: float) -> np.ndarray:
    """While the base stands, every step and every hand asks for the same pose."""
    pose, c, s = np.eye(4), math.cos(yaw), math.sin(yaw)
    pose[0, 0], pose[0, 1], pose[0, 3] = c, -s, x
    pose[1, 0], pose[1, 1], pose[1, 3] = s, c, y
    pose.flags.writeable = False
    return pose

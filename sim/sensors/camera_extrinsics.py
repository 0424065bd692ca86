"""Cameras that sit, and look, a little elsewhere than the robot takes them to."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ..scene import difficulties
from ..world import CAMERAS


def camera_errors(
    rng: np.random.Generator, sizes: difficulties.CameraExtrinsics = difficulties.SIZES.camera_extrinsics
) -> dict[str, np.ndarray]:
    """By camera, the pose (4, 4) of its optical frame in the frame where the robot takes it to be.

    Args:
        rng: of this difficulty alone.
        sizes: how far off.
    """
    return {camera: _error(rng, sizes) for camera in CAMERAS}


def _error(rng: np.random.Generator, sizes: difficulties.CameraExtrinsics) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = sizes.translation * any_direction(rng)
    pose[:3, :3] = Rotation.from_rotvec(rng.uniform(*sizes.rotation) * any_direction(rng)).as_matrix()
    return pose


def any_direction(rng: np.random.Generator) -> np.ndarray:
    """(3,) of length 1, every direction as likely."""
    vector = rng.standard_normal(3)
    return vector / np.linalg.norm(vector)

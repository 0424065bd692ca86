"""How much of a surface each pixel shows."""

from __future__ import annotations

import numpy as np

from .projection import Camera, project

FEW = 5  # neighbours that a plane needs [1]


def surface_areas(camera: Camera, points: np.ndarray, radius: float, min_cosine: float) -> np.ndarray:
    """The area of the surface that the pixel of each point shows [m^2].

    Args:
        camera: the picture's.
        points: (n, 3) of one surface in the map frame, one for each pixel or for every k-th one [m].
        radius: within which the other points tell how the surface is tilted [m].
        min_cosine: least one between surface normal and line of sight that is believed.

    Returns:
        (n,); where hardly anything lies around a point, as if it faced the camera.
    """
    fx, fy, _, _ = camera.intrinsics
    pose = camera.pose_camera_in_map
    depth = project(camera, points)[:, 2]
    sight = points - pose[:3, 3]
    sight /= np.linalg.norm(sight, axis=1, keepdims=True)
    cosine = np.maximum(np.abs(np.einsum("ij,ij->i", _normals(points, radius, sight), sight)), min_cosine)
    return depth**2 / (fx * fy) * (sight @ pose[:3, 2]) / cosine


def _normals(points: np.ndarray, radius: float, otherwise: np.ndarray) -> np.ndarray:
    """(n, 3) unit normals of the planes through what lies round each point (n, 3), `otherwise` where that is little."""
    from scipy.spatial import KDTree

    pairs = KDTree(points).query_pairs(radius, output_type="ndarray")
    first, second = np.concatenate([pairs, pairs[:, ::-1]]).T
    count = 1 + np.bincount(first, minlength=len(points))
    local = points - points.mean(axis=0)  # so that the squares below stay small
    around = local.copy()
    np.add.at(around, first, local[second])
    squares = local[:, :, None] * local[:, None, :]
    spread = squares.copy()
    np.add.at(spread, first, squares[second])
    middle = around / count[:, None]
    spread = spread / count[:, None, None] - middle[:, :, None] * middle[:, None, :]
    normals = np.linalg.eigh(spread)[1][:, :, 0]
    return np.where((count > FEW)[:, None], normals, otherwise)

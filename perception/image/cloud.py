"""Between pixels and points of the map frame."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame

_PAPER_FOCAL = 466.0  # of a 640-wide image with a field of view of 69 degrees [px]


def pixel_scale(frame: Frame) -> float:
    """Pixels of this image per pixel of the images in which the paper states its distances."""
    return frame.intrinsics[0] / _PAPER_FOCAL


def points_in_map(frame: Frame) -> np.ndarray:
    """(H, W, 3) position of every pixel [m]; NaN where there is no depth."""
    fx, fy, cx, cy = frame.intrinsics
    height, width = frame.depth.shape
    z = np.where(frame.depth > 0, frame.depth, np.nan).astype(np.float64)
    x = (np.arange(width) - cx)[None, :] / fx * z
    y = (np.arange(height) - cy)[:, None] / fy * z
    pose = frame.pose_camera_in_map
    return np.stack([x, y, z], axis=-1) @ pose[:3, :3].T + pose[:3, 3]


def project(frame: Frame, points: np.ndarray) -> np.ndarray:
    """Pixel coordinates and depth (n, 3) = (u, v, z) of map points (n, 3); z <= 0 lies behind the camera."""
    fx, fy, cx, cy = frame.intrinsics
    pose = frame.pose_camera_in_map
    local = (np.atleast_2d(points) - pose[:3, 3]) @ pose[:3, :3]
    z = local[:, 2]
    safe = np.where(np.abs(z) < 1e-6, 1e-6, z)
    return np.column_stack([fx * local[:, 0] / safe + cx, fy * local[:, 1] / safe + cy, z])


def surface_normal(points: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Unit normal (3,) of the plane through `points` (n, 3), on the side of the point `towards` (3,)."""
    centre = points.mean(axis=0)
    normal = np.linalg.svd(points - centre, full_matrices=False)[2][2] if len(points) >= 3 else towards - centre
    normal = normal / np.linalg.norm(normal)
    return normal if normal @ (towards - centre) >= 0 else -normal


def main_direction(points: np.ndarray) -> np.ndarray:
    """Unit vector (3,) along which `points` (n, 3) spread most."""
    return np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][0]


def unit(vector: np.ndarray) -> np.ndarray:
    """`vector` with length one."""
    return vector / max(float(np.linalg.norm(vector)), 1e-12)


def across(edge: np.ndarray, approach: np.ndarray) -> np.ndarray:
    """Closing direction (3,): perpendicular to the approach and to an edge of the cloth."""
    closing = np.cross(edge, approach)
    if np.linalg.norm(closing) < 1e-3:  # edge along the approach: any direction across it is as good
        closing = np.cross(approach, np.eye(3)[int(np.argmin(np.abs(approach)))])
    return unit(closing)


def clusters(points: np.ndarray, gap: float) -> np.ndarray:
    """Label (n,) of each point; two points closer than `gap` [m] share a label.  0 is the largest cluster."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    pairs = KDTree(points).query_pairs(gap, output_type="ndarray")
    n = len(points)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    count, labels = connected_components(graph, directed=False)
    order = np.argsort(-np.bincount(labels, minlength=count), kind="stable")
    rank = np.empty(count, dtype=int)
    rank[order] = np.arange(count)
    return rank[labels]


def geodesic(points: np.ndarray, start: int, gap: float) -> np.ndarray:
    """Distance (n,) along the surface from point `start` [m]; steps are at most `gap`, infinite where none lead."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import KDTree

    pairs = KDTree(points).query_pairs(gap, output_type="ndarray")
    lengths = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    graph = coo_matrix((lengths, (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    return dijkstra(graph.tocsr(), directed=False, indices=start)


def thinned(points: np.ndarray, most: int = 1500) -> np.ndarray:
    """Every k-th of the points (n, ...), so that no more than `most` are left."""
    return points[:: max(1, len(points) // most + (len(points) % most > 0))]

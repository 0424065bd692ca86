"""Clouds of points in one frame [m]: their planes, lines, patches and distances along the cloth."""

from __future__ import annotations

import numpy as np


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
    """`vector` (3,) with length one; zeros stay zeros."""
    return vector / max(float(np.linalg.norm(vector)), 1e-12)


def across(edge: np.ndarray, approach: np.ndarray) -> np.ndarray:
    """Closing direction of the fingers: a unit vector (3,) perpendicular to their approach and to an edge of the cloth.

    Args:
        edge: (3,) along the edge of the cloth, in any frame.
        approach: (3,) of the fingers, in the same frame.
    """
    closing = np.cross(edge, approach)
    if np.linalg.norm(closing) < 1e-3:  # edge along the approach: any direction across it is as good
        closing = np.cross(approach, np.eye(3)[int(np.argmin(np.abs(approach)))])
    return unit(closing)


def clusters(points: np.ndarray, gap: float) -> np.ndarray:
    """Label (n,) of each point (n, 3); two points closer than `gap` [m] share a label.  0 is the largest cluster."""
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
    """Distance (n,) of points (n, 3) along the cloth from number `start` [m], in steps of at most `gap` [m].

    It is infinite where no such steps lead.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import KDTree

    pairs = KDTree(points).query_pairs(gap, output_type="ndarray")
    lengths = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    graph = coo_matrix((lengths, (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    return dijkstra(graph.tocsr(), directed=False, indices=start)


def thinned(points: np.ndarray, max_points: int = 1500) -> np.ndarray:
    """Every k-th of the points (n, ...), so that no more than `max_points` are left."""
    return points[:: max(1, len(points) // max_points + (len(points) % max_points > 0))]

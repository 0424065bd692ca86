"""Where the person is, as far as perception has said: chains of points with a radius, or the bed before that."""

from __future__ import annotations

import numpy as np

from ...sim.errors import CaretreeError


class PersonZone:
    """Distances from places in the room to the person.

    Args:
        bed: (2, 3) lower and upper corner [m], taken as the person until a part has been seen.
        above_bed: how far the person may rise above it [m].
    """

    def __init__(self, bed: np.ndarray, above_bed: float = 0.0) -> None:
        self._bed = np.sort(np.asarray(bed, float).reshape(2, 3), axis=0)
        self._bed[1, 2] += above_bed
        self._parts: dict[str, tuple[np.ndarray, float]] = {}

    def update(self, points_in_map: np.ndarray, *, part: str, radius: float) -> None:
        """Set one part: a chain of points (n, 3) and its radius [m].

        Raises:
            CaretreeError: the points are not finite (n, 3), or the radius is negative.
        """
        points = np.atleast_2d(np.asarray(points_in_map, float))
        if points.ndim != 2 or points.shape[1] != 3 or len(points) == 0 or not np.isfinite(points).all():
            raise CaretreeError(f"the person's {part} needs finite points of shape (n, 3), not {points.shape}")
        if radius < 0:
            raise CaretreeError(f"the radius of the person's {part} is {radius} m, but cannot be below 0")
        self._parts[part] = (points, radius)

    def distance(self, positions_in_map: np.ndarray) -> np.ndarray:
        """Distance (k,) from each position (k, 3) to the nearest surface of the person [m]; 0 inside."""
        positions = np.atleast_2d(positions_in_map)
        if not self._parts:
            outside = np.maximum(np.maximum(self._bed[0] - positions, positions - self._bed[1]), 0.0)
            return np.linalg.norm(outside, axis=1)
        nearest = np.full(len(positions), np.inf)
        for points, radius in self._parts.values():
            start = points[:-1] if len(points) > 1 else points
            edge = np.diff(points, axis=0) if len(points) > 1 else np.zeros((1, 3))
            length2 = np.maximum(np.einsum("ij,ij->i", edge, edge), 1e-12)  # (s,)
            offset = positions[:, None] - start[None]  # (k, s, 3)
            along = np.clip(np.einsum("ksj,sj->ks", offset, edge) / length2, 0.0, 1.0)
            gap = np.linalg.norm(offset - along[..., None] * edge[None], axis=2).min(axis=1) - radius
            nearest = np.minimum(nearest, gap)
        return np.maximum(nearest, 0.0)

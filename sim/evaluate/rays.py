"""Where a ray from the skin meets cloth.

Seen along the ray the cloth is flat and the ray a point: it meets the triangles that have the point inside, and there
the products of neighbouring corners have one sign and are the weights of the hit.
"""

from __future__ import annotations

import numpy as np


def meets(
    vertices: np.ndarray, faces: np.ndarray, point: np.ndarray, normal: np.ndarray, below: float, above: float
) -> tuple[np.ndarray, np.ndarray]:
    """Every triangle that the line through a point of the skin meets near the skin.

    Args:
        vertices: (V, 3) [m].
        faces: (F, 3) with outward winding.
        point: (3,) on the skin [m].
        normal: (3,) outward, unit long.
        below: how far under the skin the line starts [m].
        above: how far over the skin it ends [m].

    Returns:
        (h,) heights over the skin [m], and (h,) bool, whether the triangle shows its outside.
    """
    across = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    x, y, height = np.stack([across, np.cross(normal, across), normal]) @ (vertices - point).T  # (V,) each
    # one bit for each side on which a vertex lies: with a bit in common the whole triangle lies there
    sides = (x < 0) + 2 * (x > 0) + 4 * (y < 0) + 8 * (y > 0) + 16 * (height <= -below) + 32 * (height >= above)
    near = faces[(sides[faces[:, 0]] & sides[faces[:, 1]] & sides[faces[:, 2]]) == 0]  # (f, 3)
    following = np.roll(near, -1, axis=1)
    side = x[near] * y[following] - x[following] * y[near]  # (f, 3): of edges 01, 12, 20
    total = side.sum(axis=1)
    pierced = ((side >= 0).all(axis=1) | (side <= 0).all(axis=1)) & (np.abs(total) > 1e-14)
    weight = np.roll(side[pierced], -1, axis=1) / total[pierced, None]  # of corner 0 is edge 12
    at = np.einsum("fi,fi->f", weight, height[near[pierced]])
    kept = (at > -below) & (at < above)
    return at[kept], total[pierced][kept] > 0

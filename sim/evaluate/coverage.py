"""How much of the torso front lies under the gown, and which way out.

From each torso point a ray leaves along the skin's normal.  In Plücker terms the ray passes a triangle
when it leaves all three edges on the same side; the three side products are then the weights of the hit.
"""

from __future__ import annotations

import numpy as np

from .limits import COVER_ABOVE, COVER_BELOW


def coverage(vertices: np.ndarray, faces: np.ndarray, torso: np.ndarray) -> tuple[float, float]:
    """Cover of one frame.

    Args:
        vertices: (V, 3) [m].
        faces: (F, 3) with outward winding.
        torso: (m, 6) points and outward normals [m].

    Returns:
        Part of the points under cloth, and the part of those whose top layer shows its outside.
    """
    covered = outside = 0
    for point, normal in zip(torso[:, :3], torso[:, 3:], strict=True):
        seen = vertices - point  # (V, 3)
        height = seen @ normal / max(float(normal @ normal), 1e-12)  # in normals, which are unit long
        corner = seen[faces]  # (F, 3, 3)
        # only triangles that reach the band can be hit in it
        near = (height[faces].max(axis=1) > -COVER_BELOW) & (height[faces].min(axis=1) < COVER_ABOVE)
        corner, level = corner[near], height[faces[near]]
        side = np.cross(corner, np.roll(corner, -1, axis=1)) @ normal  # (f, 3): of edges 01, 12, 20
        total = side.sum(axis=1)
        pierced = ((side >= 0).all(axis=1) | (side <= 0).all(axis=1)) & (np.abs(total) > 1e-14)
        weight = np.roll(side[pierced], -1, axis=1) / total[pierced, None]  # of corner 0 is edge 12
        at = np.einsum("fi,fi->f", weight, level[pierced])
        kept = (at > -COVER_BELOW) & (at < COVER_ABOVE)
        if kept.any():
            covered += 1
            outside += bool(total[pierced][kept][np.argmax(at[kept])] > 0)
    return covered / max(1, len(torso)), outside / max(1, covered)

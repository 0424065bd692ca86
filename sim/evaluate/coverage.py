"""How much of the torso front lies under the gown, under how many layers of it, and which way out."""

from __future__ import annotations

import numpy as np

from .limits import COVER_ABOVE, COVER_BELOW
from .rays import meets


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
        height, outward = meets(vertices, faces, point, normal, COVER_BELOW, COVER_ABOVE)
        if len(height):
            covered += 1
            outside += bool(outward[np.argmax(height)])
    return covered / max(1, len(torso)), outside / max(1, covered)


def layers(vertices: np.ndarray, faces: np.ndarray, torso: np.ndarray) -> np.ndarray:
    """(m,) int, layers of cloth over each point of the torso in one frame; arguments as for `coverage`."""
    return np.array(
        [
            len(meets(vertices, faces, point, normal, COVER_BELOW, COVER_ABOVE)[0])
            for point, normal in zip(torso[:, :3], torso[:, 3:], strict=True)
        ]
    )

"""How far line segments are from each other: capsules are segments with a radius."""

from __future__ import annotations

import numpy as np

from .compiled import njit

_SHORT = 1e-12  # squared length of a segment that is a point [m^2]


@njit()
def segment_distances(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances between every segment of `one` and every one of `other`.

    Args:
        one: (n, 2, 3) ends [m].
        other: (m, 2, 3) ends [m].

    Returns:
        (n, m) distances [m] and (n, m, 3) vectors from the nearest point of `other` to that of `one` [m].

    The closest points of two segments: Ericson, Real-Time Collision Detection, section 5.1.9.
    """
    distances = np.empty((len(one), len(other)))
    offsets = np.empty((len(one), len(other), 3))
    for i in range(len(one)):
        for j in range(len(other)):
            d1, d2 = one[i, 1] - one[i, 0], other[j, 1] - other[j, 0]
            r = one[i, 0] - other[j, 0]
            a, e = d1 @ d1, d2 @ d2
            b, c, f = d1 @ d2, d1 @ r, d2 @ r
            s = t = 0.0
            if a > _SHORT:
                if e > _SHORT:
                    denominator = a * e - b * b
                    if denominator > _SHORT * a * e:
                        s = min(max((b * f - c * e) / denominator, 0.0), 1.0)
                    t = (b * s + f) / e
                if e <= _SHORT or t < 0.0:
                    t, s = 0.0, min(max(-c / a, 0.0), 1.0)
                elif t > 1.0:
                    t, s = 1.0, min(max((b - c) / a, 0.0), 1.0)
            elif e > _SHORT:
                t = min(max(f / e, 0.0), 1.0)
            offset = r + s * d1 - t * d2
            offsets[i, j] = offset
            distances[i, j] = np.sqrt(offset @ offset)
    return distances, offsets

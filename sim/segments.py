"""How far line segments are from each other: capsules are segments with a radius."""

from __future__ import annotations

import numpy as np

from .compiled import fma, njit

_SHORT = 1e-12  # squared length of a segment that is a point [m^2]
_TOUCHING = 1e-9  # [m] axes that are nearer have no direction between them


@njit()
def _dot(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    return fma(az, bz, fma(ay, by, ax * bx))


@njit()
def segment_distances(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances between every segment of `one` and every one of `other`.

    Args:
        one: (n, 2, 3) ends [m].
        other: (m, 2, 3) ends [m].

    Returns:
        (n, m) distances [m] and (n, m, 3) vectors from the nearest point of `other` to that of `one` [m].

    The closest points of two segments: Ericson, Real-Time Collision Detection, section 5.1.9.  In numbers, not arrays
    of three, which would be made anew for every pair.
    """
    distances = np.empty((len(one), len(other)))
    offsets = np.empty((len(one), len(other), 3))
    for i in range(len(one)):
        px, py, pz = one[i, 0, 0], one[i, 0, 1], one[i, 0, 2]
        ax, ay, az = one[i, 1, 0] - px, one[i, 1, 1] - py, one[i, 1, 2] - pz
        a = _dot(ax, ay, az, ax, ay, az)
        for j in range(len(other)):
            ux, uy, uz = other[j, 0, 0], other[j, 0, 1], other[j, 0, 2]
            bx, by, bz = other[j, 1, 0] - ux, other[j, 1, 1] - uy, other[j, 1, 2] - uz
            rx, ry, rz = px - ux, py - uy, pz - uz
            e = _dot(bx, by, bz, bx, by, bz)
            b, c, f = _dot(ax, ay, az, bx, by, bz), _dot(ax, ay, az, rx, ry, rz), _dot(bx, by, bz, rx, ry, rz)
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
            x, y, z = rx + s * ax - t * bx, ry + s * ay - t * by, rz + s * az - t * bz
            offsets[i, j, 0], offsets[i, j, 1], offsets[i, j, 2] = x, y, z
            distances[i, j] = np.sqrt(_dot(x, y, z, x, y, z))
    return distances, offsets


@njit()
def capsule_gaps(
    one: np.ndarray, one_radii: np.ndarray, other: np.ndarray, other_radii: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Gaps between the surfaces of every capsule of `one` and every one of `other`.

    Args:
        one: (n, 2, 3) ends of their axes [m].
        one_radii: (n,) [m].
        other: (m, 2, 3) ends of their axes [m].
        other_radii: (m,) [m].

    Returns:
        (n, m) gaps [m], negative inside, and (n, m, 3) directions from `other` to `one`.
    """
    gaps, away = segment_distances(one, other)
    for i in range(len(one)):
        for j in range(len(other)):
            apart = max(gaps[i, j], _TOUCHING)
            gaps[i, j] = gaps[i, j] - one_radii[i] - other_radii[j]
            for k in range(3):
                away[i, j, k] = away[i, j, k] / apart
    return gaps, away


@njit()
def nearest_gaps(one: np.ndarray, one_radii: np.ndarray, other: np.ndarray, other_radii: np.ndarray) -> np.ndarray:
    """Least gap (n,) of every capsule of `one` to any of `other`; arguments as for `capsule_gaps` [m]."""
    apart, _ = segment_distances(one, other)
    nearest = np.full(len(one), np.inf)
    for i in range(len(one)):
        for j in range(len(other)):
            nearest[i] = min(nearest[i], apart[i, j] - one_radii[i] - other_radii[j])
    return nearest


@njit()
def any_nearer(
    one: np.ndarray, one_radii: np.ndarray, other: np.ndarray, other_radii: np.ndarray, least: np.ndarray
) -> bool:
    """Whether any gap of `capsule_gaps`, whose arguments these are, is below the least one (n, m) asked for it [m]."""
    for i in range(len(one)):
        for j in range(len(other)):
            # of most pairs the spheres around both are too far from each other already
            square = one_long = other_long = 0.0
            for k in range(3):
                square += (one[i, 0, k] + one[i, 1, k] - other[j, 0, k] - other[j, 1, k]) ** 2
                one_long += (one[i, 1, k] - one[i, 0, k]) ** 2
                other_long += (other[j, 1, k] - other[j, 0, k]) ** 2
            reach = np.sqrt(one_long) + np.sqrt(other_long)
            reach += 2.0 * (one_radii[i] + other_radii[j] + least[i, j] + _TOUCHING)
            if reach > 0.0 and square < reach * reach:
                apart, _ = segment_distances(one[i : i + 1], other[j : j + 1])
                if apart[0, 0] - one_radii[i] - other_radii[j] < least[i, j]:
                    return True
    return False


@njit()
def furthest_moved(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """How far (n,) the end of each segment that goes further has gone; both (n, 2, 3) [m]."""
    ways = np.zeros(len(before))
    for i in range(len(before)):
        for end in range(2):
            square = 0.0
            for k in range(3):
                way = after[i, end, k] - before[i, end, k]
                square += way * way
            ways[i] = max(ways[i], np.sqrt(square))
    return ways


@njit()
def box_distances(segments: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Distance (n,) from five points of each segment (n, 2, 3) to a box (2, 3), the least of them; 0 inside [m]."""
    nearest = np.full(len(segments), np.inf)
    for i in range(len(segments)):
        for n in range(5):
            square = 0.0
            for k in range(3):
                first, last = segments[i, 0, k], segments[i, 1, k]
                place = first + n / 4 * (last - first)
                outside = max(box[0, k] - place, place - box[1, k], 0.0)
                square += outside * outside
            nearest[i] = min(nearest[i], np.sqrt(square))
    return nearest

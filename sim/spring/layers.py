"""A cloth meets itself: no vertex passes through a triangle of another fold, compiled.

Each vertex that comes near a triangle is on one side of it and stays there for as long as they are near.  Nothing is
done about edges that cross edges, and what is through already where it is first seen stays through.
"""

from __future__ import annotations

import numpy as np

from ..compiled import njit
from .touching import FASTEST, PUSH

THICK = 0.004  # that a vertex keeps from a triangle [m]
CELL = 0.06  # of the grid in which triangles are looked up; at least as wide as one reaches [m]
APART = 0.03  # nearer than this in the rest shape they are neighbours, not folds [m]
BUCKETS = 4096


class Layers:
    """Which vertices are near which triangles of one cloth, and on which side.

    Args:
        rest: (V, 3) rest shape [m].
        faces: (F, 3).
    """

    def __init__(self, rest: np.ndarray, faces: np.ndarray) -> None:
        self.faces = np.ascontiguousarray(faces, np.int64)
        middles = rest[faces].mean(axis=1)
        far = np.linalg.norm(rest[faces] - middles[:, None], axis=2).max(axis=1) + APART
        near = np.linalg.norm(rest[:, None] - middles[None], axis=2) < far
        self._side = np.where(near, NEIGHBOUR, 0).astype(np.int8)  # (V, F)
        self.pairs = np.zeros((0, 2), np.int64)

    def look(self, x: np.ndarray, reach: float) -> None:
        """Find the pairs that are within `reach` [m]; those that stay near keep their sides."""
        found = _near(x, self.faces, self._side, reach)
        _sort_out(x, self.faces, self._side, self.pairs, found)
        self.pairs = found

    def forget(self) -> None:
        """Forget which vertices are near, and their sides."""
        self._side[self.pairs[:, 0], self.pairs[:, 1]] = 0
        self.pairs = np.zeros((0, 2), np.int64)

    def part(self, x: np.ndarray, v: np.ndarray, loose: np.ndarray, dt: float, rounds: int) -> None:
        """Change `v` (V, 3) so that no pair closes in the next step of `dt` [s]; `loose` is one over each mass."""
        _part(x, v, loose, self.faces, self._side, self.pairs, dt, rounds)


NEIGHBOUR = 2  # in the table of sides: never looked at


@njit(inline="always")
def _bucket(a, b, c):
    return (a * 73856093 ^ b * 19349663 ^ c * 83492791) % BUCKETS


@njit(inline="always")
def _plane(x, a, b, c, p, normal):
    """Unit normal of triangle a b c into `normal`; how far `p` is above it, and the shares of b and c in that place."""
    for d in range(3):
        e, f = (d + 1) % 3, (d + 2) % 3
        normal[d] = (x[b, e] - x[a, e]) * (x[c, f] - x[a, f]) - (x[b, f] - x[a, f]) * (x[c, e] - x[a, e])
    size = np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2) + 1e-12
    above, uu, vv, uv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(3):
        normal[d] /= size
        u, v, w = x[b, d] - x[a, d], x[c, d] - x[a, d], p[d] - x[a, d]
        above += normal[d] * w
        uu += u * u
        vv += v * v
        uv += u * v
        uw += u * w
        vw += v * w
    square = uu * vv - uv * uv + 1e-18
    return above, (vv * uw - uv * vw) / square, (uu * vw - uv * uw) / square


@njit()
def _near(x, faces, side, reach):
    """(n, 2) vertices and triangles within about `reach`, which are no neighbours."""
    first, after = np.full(BUCKETS, -1), np.empty(len(faces), np.int64)
    cells, here = np.empty((len(faces), 3), np.int64), np.empty(3, np.int64)
    for f in range(len(faces)):
        for d in range(3):
            middle = (x[faces[f, 0], d] + x[faces[f, 1], d] + x[faces[f, 2], d]) / 3.0
            cells[f, d] = int(np.floor(middle / CELL))
        k = _bucket(cells[f, 0], cells[f, 1], cells[f, 2])
        after[f] = first[k]
        first[k] = f
    out, count = np.empty((64 * len(x), 2), np.int64), 0
    normal = np.empty(3)
    for i in range(len(x)):
        for n in range(27):
            here[0] = int(np.floor(x[i, 0] / CELL)) + n % 3 - 1
            here[1] = int(np.floor(x[i, 1] / CELL)) + n // 3 % 3 - 1
            here[2] = int(np.floor(x[i, 2] / CELL)) + n // 9 - 1
            f = first[_bucket(here[0], here[1], here[2])]
            while f >= 0:
                mine = cells[f, 0] == here[0] and cells[f, 1] == here[1] and cells[f, 2] == here[2]
                if mine and side[i, f] != NEIGHBOUR and count < len(out):
                    above, b, c = _plane(x, faces[f, 0], faces[f, 1], faces[f, 2], x[i], normal)
                    if abs(above) < reach and min(b, c, 1.0 - b - c) > -0.3:
                        out[count, 0], out[count, 1] = i, f
                        count += 1
                f = after[f]
    return out[:count].copy()


@njit()
def _sort_out(x, faces, side, before, found):
    """Forget the sides of pairs that parted, and tell those of pairs that are new."""
    sides, normal = np.empty(len(found), np.int8), np.empty(3)
    for n in range(len(found)):
        i, f = found[n, 0], found[n, 1]
        sides[n] = side[i, f]
        if sides[n] == 0:
            above, _, _ = _plane(x, faces[f, 0], faces[f, 1], faces[f, 2], x[i], normal)
            sides[n] = 1 if above >= 0.0 else -1
    for n in range(len(before)):
        side[before[n, 0], before[n, 1]] = 0
    for n in range(len(found)):
        side[found[n, 0], found[n, 1]] = sides[n]


@njit()
def _part(x, v, loose, faces, side, pairs, dt, rounds):
    normal = np.empty(3)
    for _ in range(rounds):
        for n in range(len(pairs)):
            i, f = pairs[n, 0], pairs[n, 1]
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            above, sb, sc = _plane(x, a, b, c, x[i], normal)
            sa = 1.0 - sb - sc
            if min(sa, sb, sc) < -0.05:
                continue
            sign = side[i, f]
            gap = sign * above - THICK
            leaving = 0.0
            for d in range(3):
                leaving += sign * normal[d] * (v[i, d] - sa * v[a, d] - sb * v[b, d] - sc * v[c, d])
            floor = -gap / dt if gap > 0.0 else min(-PUSH * gap / dt, FASTEST)
            mass = loose[i] + sa * sa * loose[a] + sb * sb * loose[b] + sc * sc * loose[c]
            if leaving >= floor or mass == 0.0:
                continue
            push = sign * (floor - leaving) / mass
            for d in range(3):
                v[i, d] += loose[i] * push * normal[d]
                v[a, d] -= loose[a] * sa * push * normal[d]
                v[b, d] -= loose[b] * sb * push * normal[d]
                v[c, d] -= loose[c] * sc * push * normal[d]

"""Fingers that push a cloth of springs: boxes that go where they are told, met by every place of a triangle.

The points of `touching.py` are 2.75 cm apart, and a finger is 2.2 cm wide: it would slip between them.  Here every
triangle near a box is met at 15 places, 1.4 cm apart.  The cloth gives way and the boxes do not.
"""

from __future__ import annotations

import numpy as np

from ..compiled import njit
from .touching import FASTEST, FRICTION, NORMAL, PUSH, SURFACE, on_box

PLACES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 4.0  # barycentric, (15, 3)
COLUMNS = 15


@njit()
def near_boxes(x: np.ndarray, faces: np.ndarray, boxes: np.ndarray, reach: float, out: np.ndarray) -> int:
    """Fill `out` (n, 2) with which triangle is within about `reach` [m] of which box; returns how many.

    Args:
        x: (V, 3) [m].
        faces: (F, 3).
        boxes: (B, 15) middle, half edges, axes as a matrix row by row, see `solids.Solids`.
        reach: distance [m].
        out: at least (F * B, 2).
    """
    count = 0
    for b in range(len(boxes)):
        box = boxes[b]
        for f in range(len(faces)):
            inside = True
            for d in range(3):
                far = reach
                for axis in range(3):
                    far += abs(box[6 + 3 * d + axis]) * box[3 + axis]
                p, q, r = x[faces[f, 0], d], x[faces[f, 1], d], x[faces[f, 2], d]
                if min(p, q, r) > box[d] + far or max(p, q, r) < box[d] - far:
                    inside = False
                    break
            if inside:
                out[count, 0], out[count, 1] = f, b
                count += 1
    return count


@njit()
def push_aside(
    x: np.ndarray,
    v: np.ndarray,
    loose: np.ndarray,
    faces: np.ndarray,
    pairs: np.ndarray,
    boxes: np.ndarray,
    box_speeds: np.ndarray,
    places: np.ndarray,
    friction: float,
    margin: float,
    dt: float,
    rounds: int,
) -> int:
    """Change `v` so that no place of a triangle enters a box in the next step; returns how many touch.

    Args:
        x: (V, 3) positions [m].
        v: (V, 3) velocities that springs and weight would give [m/s].
        loose: (V,) one over the mass, 0 of those that are held [1/kg].
        faces: (F, 3).
        pairs: (n, 2) of `near_boxes`.
        boxes: (B, 15).
        box_speeds: (B, 6) of the middle [m/s] and of turning [rad/s].
        places: (P, 3) barycentric, `PLACES`.
        friction: Coulomb coefficient.
        margin: that the cloth keeps [m].
        dt: step [s].
        rounds: of impulses.
    """
    who = np.empty((len(pairs) * len(places) + 1, 2), np.int64)
    found = np.empty((len(pairs) * len(places) + 1, COLUMNS))
    point, away, count = np.empty(3), np.empty(3), 0
    for n in range(len(pairs)):
        f, b = pairs[n, 0], pairs[n, 1]
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        for s in range(len(places)):
            one, two, three = places[s, 0], places[s, 1], places[s, 2]
            mass = one * one * loose[i] + two * two * loose[j] + three * three * loose[k]
            if mass == 0.0:
                continue
            for d in range(3):
                point[d] = one * x[i, d] + two * x[j, d] + three * x[k, d]
            contact = found[count]
            gap, _ = on_box(point, boxes[b], box_speeds[b], away, contact)
            gap -= margin
            leaving = 0.0
            for d in range(3):
                speed = one * v[i, d] + two * v[j, d] + three * v[k, d]
                leaving += contact[NORMAL + d] * (speed - contact[SURFACE + d])
            if gap + dt * leaving > 0.0:
                continue
            contact[3] = -gap / dt if gap > 0.0 else min(-PUSH * gap / dt, FASTEST)
            contact[11], contact[FRICTION], contact[12] = 1.0 / mass, friction, 0.0
            who[count, 0], who[count, 1] = f, s
            count += 1
    for _ in range(rounds):
        for c in range(count):
            _impulse(v, loose, faces[who[c, 0]], places[who[c, 1]], found[c])
    return count


@njit(inline="always")
def _impulse(v, loose, face, place, contact):
    """One contact: normal impulse that never draws, and friction on what slides after it."""
    leaving = 0.0
    slip = np.empty(3)
    for d in range(3):
        slip[d] = place[0] * v[face[0], d] + place[1] * v[face[1], d] + place[2] * v[face[2], d] - contact[SURFACE + d]
        leaving += contact[NORMAL + d] * slip[d]
    pressed = max(contact[12] + contact[11] * (contact[3] - leaving), 0.0)
    change = pressed - contact[12]
    contact[12] = pressed
    size = 0.0
    for d in range(3):
        slip[d] -= leaving * contact[NORMAL + d]
        size += slip[d] * slip[d]
    size = np.sqrt(size)
    hold = min(contact[FRICTION] * max(change, 0.0), contact[11] * size) / size if size > 1e-9 else 0.0
    for d in range(3):
        push = change * contact[NORMAL + d] - hold * slip[d]
        for m in range(3):
            v[face[m], d] += loose[face[m]] * place[m] * push

"""Fingers that push a cloth of springs: boxes that go where they are told, each met where a triangle is nearest to it.

The points of `touching.py` are 2.75 cm apart, and a finger is 2.2 cm wide: it would slip between them.  Here every
triangle near a box has one contact with it, between the two nearest points, as in Bullet.  The boxes have sharp edges,
which the margin rounds.  The cloth gives way and the boxes do not.
"""

from __future__ import annotations

import numpy as np

from ..compiled import njit
from .touching import FASTEST, FRICTION, NORMAL, PUSH, SURFACE

PLACES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 4.0  # where the search begins, (15, 3)
SEARCH = 24  # times at most that a place goes to the nearest point of the box and back to that of the triangle
COLUMNS = 15
ENOUGH = 1e-6  # what a search gains at last [m]


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
    friction: float,
    margin: float,
    dt: float,
    rounds: int,
) -> int:
    """Change `v` so that no triangle comes nearer to a box than the margin in the next step; returns how many touch.

    Args:
        x: (V, 3) positions [m].
        v: (V, 3) velocities that springs and weight would give [m/s].
        loose: (V,) one over the mass, 0 of those that are held [1/kg].
        faces: (F, 3).
        pairs: (n, 2) of `near_boxes`.
        boxes: (B, 15).
        box_speeds: (B, 6) of the middle [m/s] and of turning [rad/s].
        friction: Coulomb coefficient.
        margin: that the cloth keeps [m].
        dt: step [s].
        rounds: of impulses.
    """
    who, shares = np.empty(len(pairs), np.int64), np.empty((len(pairs), 3))
    found, corners, count = np.empty((len(pairs), COLUMNS)), np.empty((3, 3)), 0
    for n in range(len(pairs)):
        f, box, speed = pairs[n, 0], boxes[pairs[n, 1]], box_speeds[pairs[n, 1]]
        for m in range(3):
            for axis in range(3):
                corners[m, axis] = 0.0
                for d in range(3):
                    corners[m, axis] += box[6 + 3 * d + axis] * (x[faces[f, m], d] - box[d])
        share, contact = shares[count], found[count]
        gap = nearest(corners, box[3:6], share, contact[:3]) - margin
        mass, leaving = 0.0, 0.0
        for m in range(3):
            mass += share[m] ** 2 * loose[faces[f, m]]
        if mass == 0.0:
            continue
        a, b, c = contact[0], contact[1], contact[2]
        for d in range(3):
            contact[NORMAL + d] = box[6 + 3 * d] * a + box[7 + 3 * d] * b + box[8 + 3 * d] * c
            contact[4 + d] = -box[d]  # becomes the place as seen from the box's middle
            for m in range(3):
                contact[4 + d] += share[m] * x[faces[f, m], d]
        rx, ry, rz = contact[4], contact[5], contact[6]
        contact[SURFACE] = speed[0] + speed[4] * rz - speed[5] * ry
        contact[SURFACE + 1] = speed[1] + speed[5] * rx - speed[3] * rz
        contact[SURFACE + 2] = speed[2] + speed[3] * ry - speed[4] * rx
        for d in range(3):
            leaving -= contact[NORMAL + d] * contact[SURFACE + d]
            for m in range(3):
                leaving += contact[NORMAL + d] * share[m] * v[faces[f, m], d]
        if gap + dt * leaving > 0.0:
            continue
        contact[3] = -gap / dt if gap > 0.0 else min(-PUSH * gap / dt, FASTEST)
        contact[11], contact[FRICTION], contact[12] = 1.0 / mass, friction, 0.0
        who[count] = f
        count += 1
    for _ in range(rounds):
        for n in range(count):
            _impulse(v, loose, faces[who[n]], shares[n], found[n])
    return count


@njit()
def nearest(corners: np.ndarray, half: np.ndarray, share: np.ndarray, away: np.ndarray) -> float:
    """Where a triangle is nearest to a box, and how far away [m]; below 0 inside, by the least depth.

    From the nearest of `PLACES` it goes to the nearest point of the box and from there to that of the triangle, and
    again: both are convex, so that this ends where they are nearest.

    Args:
        corners: (3, 3) of the triangle in the box's frame [m].
        half: (3,) half edges of the box [m].
        share: (3,) gets the share of each corner in the place.
        away: (3,) gets the unit vector from the box to the place, in the box's frame.
    """
    place, trial, least = np.empty(3), np.empty(3), 1e9
    for s in range(len(PLACES)):
        for d in range(3):
            place[d] = PLACES[s, 0] * corners[0, d] + PLACES[s, 1] * corners[1, d] + PLACES[s, 2] * corners[2, d]
        gap = _from_box(place, half, trial)
        if gap < least:
            least = gap
            for d in range(3):
                share[d], away[d] = PLACES[s, d], trial[d]
    before = least + 1.0
    for _ in range(SEARCH):
        if least <= 0.0 or before - least < ENOUGH:
            break
        before = least
        for d in range(3):
            place[d] = share[0] * corners[0, d] + share[1] * corners[1, d] + share[2] * corners[2, d]
            place[d] = min(max(place[d], -half[d]), half[d])
        _on_triangle(place, corners, share)
        for d in range(3):
            place[d] = share[0] * corners[0, d] + share[1] * corners[1, d] + share[2] * corners[2, d]
        least = _from_box(place, half, away)
    return least


@njit(inline="always")
def _from_box(place, half, away):
    """Distance of a place from a box in its own frame, below 0 inside; the way out into `away`."""
    square, most, side = 0.0, -1e9, 0
    for d in range(3):
        over = abs(place[d]) - half[d]
        if over > most:
            most, side = over, d
        away[d] = np.copysign(max(over, 0.0), place[d])
        square += away[d] * away[d]
    if square == 0.0:
        for d in range(3):
            away[d] = np.copysign(1.0, place[d]) if d == side else 0.0
        return most
    square = np.sqrt(square)
    for d in range(3):
        away[d] /= square
    return square


@njit(inline="always")
def _on_triangle(place, corners, share):
    """Shares of the corners in the triangle's point nearest to a place: in its plane, or else on one of its edges."""
    uu, vv, uv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(3):
        u, v, w = corners[1, d] - corners[0, d], corners[2, d] - corners[0, d], place[d] - corners[0, d]
        uu += u * u
        vv += v * v
        uv += u * v
        uw += u * w
        vw += v * w
    square = uu * vv - uv * uv + 1e-18
    share[1], share[2] = (vv * uw - uv * vw) / square, (uu * vw - uv * uw) / square
    share[0] = 1.0 - share[1] - share[2]
    if min(share[0], share[1], share[2]) >= 0.0:
        return
    least = 1e9
    for m in range(3):
        k = (m + 1) % 3
        along, length = 0.0, 1e-18
        for d in range(3):
            edge = corners[k, d] - corners[m, d]
            along += edge * (place[d] - corners[m, d])
            length += edge * edge
        t, far = min(max(along / length, 0.0), 1.0), 0.0
        for d in range(3):
            far += (corners[m, d] + t * (corners[k, d] - corners[m, d]) - place[d]) ** 2
        if far < least:
            least = far
            share[m], share[k], share[(m + 2) % 3] = 1.0 - t, t, 0.0


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

"""Cloth meets capsules and boxes: where it does, and the impulses that keep them apart, compiled.

Every vertex and the middle of every edge is a point of the cloth that touches: with cells of 5.5 cm a grid of 2.75 cm,
through which a hand of 2.7 cm radius does not dip farther than the margin that the cloth keeps.  Impulses are found
one contact after the other, several times over (projected Gauss-Seidel), with Coulomb's law for each body.
"""

from __future__ import annotations

import numpy as np

from ..compiled import njit

PUSH = 0.2  # share of a depth that one step takes back
FASTEST = 0.5  # with which what is too deep comes out [m/s]
NEAR = 1e-3  # what will be farther apart than this after the step does not touch [m]
TAUT = 0.9  # share of its longest at which an edge is looked at
ROUND = 0.03  # radius of a box's edges, which points 2.75 cm apart must not catch at [m]
NORMAL, FLOOR, SURFACE, POINT, FRICTION, MASS, SUM = 0, 3, 4, 7, 10, 11, 12  # columns of a contact
COLUMNS = 15


@njit()
def near_pairs(
    x: np.ndarray,
    one: np.ndarray,
    other: np.ndarray,
    capsules: np.ndarray,
    radii: np.ndarray,
    boxes: np.ndarray,
    reach: float,
    out: np.ndarray,
) -> int:
    """Fill `out` (n, 2) with which point of the cloth is within about `reach` of which solid; returns how many.

    Points are the middles of `one` and `other`; capsules come first, then boxes, (B, 15): middle, half edges, axes.
    """
    count = 0
    low, high = np.empty(3), np.empty(3)
    for k in range(len(capsules) + len(boxes)):
        for d in range(3):
            if k < len(capsules):
                a, b, far = capsules[k, 0, d], capsules[k, 1, d], radii[k] + reach
                low[d], high[d] = min(a, b) - far, max(a, b) + far
            else:
                box = boxes[k - len(capsules)]
                far = reach
                for axis in range(3):
                    far += abs(box[6 + 3 * d + axis]) * box[3 + axis]
                low[d], high[d] = box[d] - far, box[d] + far
        for s in range(len(one)):
            i, j = one[s], other[s]
            inside = True
            for d in range(3):
                place = 0.5 * (x[i, d] + x[j, d])
                inside = inside and low[d] < place < high[d]
            if inside:
                out[count, 0], out[count, 1] = s, k
                count += 1
    return count


@njit(inline="always")
def _on_capsule(point, ends, speed, radius, contact):
    """Normal and velocity of the surface into `contact`; returns the gap."""
    along, square = 0.0, 1e-12
    for d in range(3):
        way = ends[1, d] - ends[0, d]
        along += (point[d] - ends[0, d]) * way
        square += way * way
    t = min(max(along / square, 0.0), 1.0)
    distance = 0.0
    for d in range(3):
        contact[NORMAL + d] = point[d] - ends[0, d] - t * (ends[1, d] - ends[0, d])
        contact[SURFACE + d] = speed[0, d] + t * (speed[1, d] - speed[0, d])
        distance += contact[NORMAL + d] ** 2
    distance = np.sqrt(distance)
    if distance < 1e-6:  # on the axis: out to where the front of a lying body is
        contact[NORMAL], contact[NORMAL + 1], contact[NORMAL + 2] = 0.0, 0.0, 1.0
    else:
        for d in range(3):
            contact[NORMAL + d] /= distance
    return distance - radius


@njit(inline="always")
def on_box(
    point: np.ndarray, box: np.ndarray, speed: np.ndarray, away: np.ndarray, contact: np.ndarray
) -> tuple[float, bool]:
    """Normal and velocity of the surface into `contact`; returns the gap, and whether the surface is flat there.

    Edges are round; `away` (3,) is room to work in.
    """
    rounded = min(ROUND, box[3], box[4], box[5])
    beyond, most, side, outside = 0.0, -1e9, 0, 0
    for axis in range(3):
        local = 0.0
        for d in range(3):
            local += box[6 + 3 * d + axis] * (point[d] - box[d])
        over = abs(local) - box[3 + axis] + rounded
        if over > most:
            most, side = over, axis
        if over > 0.0:
            outside += 1
            beyond += over * over
        away[axis] = np.copysign(max(over, 1e-12), local)
    if outside < 2:
        for axis in range(3):
            away[axis] = np.copysign(1.0, away[axis]) if axis == side else 0.0
        gap = most
    else:
        gap = np.sqrt(beyond)
        for axis in range(3):
            away[axis] /= gap
    for d in range(3):
        contact[NORMAL + d] = box[6 + 3 * d] * away[0] + box[7 + 3 * d] * away[1] + box[8 + 3 * d] * away[2]
    rx, ry, rz = point[0] - box[0], point[1] - box[1], point[2] - box[2]
    contact[SURFACE] = speed[0] + speed[4] * rz - speed[5] * ry
    contact[SURFACE + 1] = speed[1] + speed[5] * rx - speed[3] * rz
    contact[SURFACE + 2] = speed[2] + speed[3] * ry - speed[4] * rx
    return gap - rounded, outside < 2


@njit()
def _find_contacts(
    x, v, loose, one, other, pairs, capsules, speeds, radii, boxes, box_speeds, friction, margin, dt, who, contacts
):
    """Fill `who` (n, 4) with both vertices, the solid and 0, and `contacts` (n, COLUMNS); returns how many."""
    count = 0
    point, away = np.empty(3), np.empty(3)
    for p in range(len(pairs)):
        s, k = pairs[p, 0], pairs[p, 1]
        i, j = one[s], other[s]
        mass = loose[i] if i == j else 0.25 * (loose[i] + loose[j])
        if mass == 0.0:
            continue
        for d in range(3):
            point[d] = 0.5 * (x[i, d] + x[j, d])
        contact = contacts[count]
        if k < len(capsules):
            gap = _on_capsule(point, capsules[k], speeds[k], radii[k], contact) - margin
        else:
            n = k - len(capsules)
            gap, flat = on_box(point, boxes[n], box_speeds[n], away, contact)
            gap -= margin
            if flat and i != j:  # the middle of an edge is no lower than its ends
                continue
        leaving = 0.0
        for d in range(3):
            leaving += contact[NORMAL + d] * (0.5 * (v[i, d] + v[j, d]) - contact[SURFACE + d])
            contact[POINT + d] = point[d] - margin * contact[NORMAL + d]
            contact[SUM + d] = 0.0
        if gap + dt * leaving > NEAR:
            continue
        contact[FLOOR] = -gap / dt if gap > 0.0 else min(-PUSH * gap / dt, FASTEST)
        contact[FRICTION], contact[MASS] = friction[k], 1.0 / mass
        who[count, 0], who[count, 1], who[count, 2] = i, j, k
        count += 1
    return count


@njit()
def _part(v, loose, who, contacts, impulses):
    """One round: change `v` so that no contact closes, with friction; impulses on vertices into `impulses` (V, 3)."""
    wanted = np.empty(3)
    for c in range(len(who)):
        i, j, contact = who[c, 0], who[c, 1], contacts[c]
        leaving, pressed = 0.0, 0.0
        for d in range(3):
            wanted[d] = 0.5 * (v[i, d] + v[j, d]) - contact[SURFACE + d]
            leaving += contact[NORMAL + d] * wanted[d]
            pressed += contact[NORMAL + d] * contact[SUM + d]
        if pressed == 0.0 and leaving >= contact[FLOOR]:
            continue
        before = pressed
        pressed = max(pressed + contact[MASS] * (contact[FLOOR] - leaving), 0.0)
        size = 0.0
        for d in range(3):  # friction in all, after this round
            n = contact[NORMAL + d]
            wanted[d] = contact[SUM + d] - before * n - contact[MASS] * (wanted[d] - leaving * n)
            size += wanted[d] ** 2
        most = contact[FRICTION] * pressed
        scale = most / np.sqrt(size) if size > most * most else 1.0
        share = 1.0 if i == j else 0.5
        for d in range(3):
            change = pressed * contact[NORMAL + d] + scale * wanted[d] - contact[SUM + d]
            contact[SUM + d] += change
            change *= share
            v[i, d] += loose[i] * change
            impulses[i, d] += change
            if i != j:
                v[j, d] += loose[j] * change
                impulses[j, d] += change


@njit(inline="always")
def _draw(x, v, loose, i, j, pull, length, impulses):
    """Draw both ends of an edge together with the impulse `pull`."""
    for d in range(3):
        change = pull * (x[j, d] - x[i, d]) / length
        v[i, d] += loose[i] * change
        v[j, d] -= loose[j] * change
        impulses[i, d] += change
        impulses[j, d] -= change


@njit()
def _find_taut(x, v, loose, one, other, longest, pulls, impulses):
    """(T,) edges that are nearly as long as they may get; they begin with the last step's `pulls` (E,)."""
    out, count = np.empty(len(one), np.int64), 0
    for e in range(len(one)):
        i, j = one[e], other[e]
        square = (x[j, 0] - x[i, 0]) ** 2 + (x[j, 1] - x[i, 1]) ** 2 + (x[j, 2] - x[i, 2]) ** 2
        if square > (TAUT * longest[e]) ** 2 and loose[i] + loose[j] > 0.0:
            out[count] = e
            count += 1
            _draw(x, v, loose, i, j, pulls[e], np.sqrt(square), impulses)
        else:
            pulls[e] = 0.0
    return out[:count]


@njit()
def _limit_stretch(x, v, loose, one, other, longest, taut, dt, pulls, impulses):
    """One round: change `v` so that no edge of `taut` (T,) gets longer than `longest`; `pulls` are its impulses."""
    for n in range(len(taut)):
        e = taut[n]
        i, j = one[e], other[e]
        square, growing = 0.0, 0.0
        for d in range(3):
            way = x[j, d] - x[i, d]
            square += way * way
            growing += way * (v[j, d] - v[i, d])
        length = np.sqrt(square)
        spare = longest[e] - length
        pull = growing / length - spare / dt * (1.0 if spare > 0.0 else PUSH)
        pull = max(pull / (loose[i] + loose[j]), -pulls[e])
        pulls[e] += pull
        _draw(x, v, loose, i, j, pull, length, impulses)


@njit()
def _share_out(who, contacts, out):
    """Add to `out` (n, 7) what cloth gives to each solid: impulse, its size, and the place of each weighted by that."""
    for c in range(len(who)):
        k, contact = who[c, 2], contacts[c]
        size = np.sqrt(contact[SUM] ** 2 + contact[SUM + 1] ** 2 + contact[SUM + 2] ** 2)
        out[k, 3] += size
        for d in range(3):
            out[k, d] -= contact[SUM + d]
            out[k, 4 + d] += size * contact[POINT + d]


@njit()
def meet(
    x: np.ndarray,
    v: np.ndarray,
    loose: np.ndarray,
    one: np.ndarray,
    other: np.ndarray,
    pairs: np.ndarray,
    capsules: np.ndarray,
    speeds: np.ndarray,
    radii: np.ndarray,
    boxes: np.ndarray,
    box_speeds: np.ndarray,
    friction: np.ndarray,
    margin: float,
    dt: float,
    edge_one: np.ndarray,
    edge_other: np.ndarray,
    longest: np.ndarray,
    pulls: np.ndarray,
    rounds: int,
    given: np.ndarray,
) -> np.ndarray:
    """Change `v` so that the cloth passes through nothing and is stretched no farther than it may be.

    Args:
        x: (V, 3) positions.
        v: (V, 3) velocities that springs and weight would give.
        loose: (V,) one over the mass, 0 of those that are held.
        one: (P,) a vertex of each point that touches.
        other: (P,) the other one of its edge, or the same again.
        pairs: (n, 2) points and solids that are near each other.
        capsules: (K, 2, 3) ends.
        speeds: (K, 2, 3) of these.
        radii: (K,).
        boxes: (B, 15), see `Solids`.
        box_speeds: (B, 6).
        friction: (K + B,) between the cloth and each.
        margin: that the cloth keeps.
        dt: step.
        edge_one: (E,) one end of each edge.
        edge_other: (E,) the other.
        longest: (E,) that it may get.
        pulls: (E,) impulses that keep them so, of the last step; of this one afterwards.
        rounds: of impulses.
        given: (K + B, 7), see `_share_out`.

    Returns:
        (V, 3) impulse on each vertex.
    """
    who, contacts = np.empty((len(pairs) + 1, 3), np.int64), np.empty((len(pairs) + 1, COLUMNS))
    count = _find_contacts(
        x, v, loose, one, other, pairs, capsules, speeds, radii, boxes, box_speeds, friction, margin, dt, who, contacts
    )
    who, contacts = who[:count], contacts[:count]
    impulses = np.zeros((len(x), 3))
    taut = _find_taut(x, v, loose, edge_one, edge_other, longest, pulls, impulses)
    for _ in range(rounds):
        _limit_stretch(x, v, loose, edge_one, edge_other, longest, taut, dt, pulls, impulses)
        _part(v, loose, who, contacts, impulses)
    _share_out(who, contacts, given)
    return impulses

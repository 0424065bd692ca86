"""Where the person is, as far as perception has said: chains of points with a radius.

What has not been seen yet may be anywhere over the bed, so until all of the person is known the bed counts too; the
body, which keeps to the middle of the bed, is expected there.
"""

from __future__ import annotations

import numpy as np

from ...perception.person.arm_fit import turned_about_shoulder
from ...perception.person.person_facts import PERSON
from ...sim.errors import CaretreeError
from ...sim.segments import box_distances, capsule_gaps, nearest_gaps, segment_distances

ARMS = ("left arm", "right arm")
HEAD, TRUNK, LEGS = "head", "trunk", "legs"
WHOLE = "person"  # told as one part, nothing else is looked for
PARTS = (HEAD, TRUNK, LEGS, *ARMS)


class PersonZone:
    """The person's parts as capsules, and distances to them.

    Args:
        bed: (2, 3) lower and upper corner [m]; the head lies at its lower y.
        above_bed: how far the person may rise above it [m].

    Attributes:
        names: (m,) part that each capsule belongs to.
        ends: (m, 2, 3) of their axes [m].
        radii: (m,) [m].
        known: whether all of the person has been seen at least once.
    """

    def __init__(self, bed: np.ndarray, above_bed: float = 0.0) -> None:
        mattress = np.sort(np.asarray(bed, float).reshape(2, 3), axis=0)
        self._bed = mattress.copy()
        self._bed[1, 2] += above_bed
        self._parts: dict[str, tuple[np.ndarray, float]] = {}
        # arm -> its points and where a hand took it, and where that hand was last
        self._held: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray | None]] = {}
        self._has_bed = bool(np.ptp(mattress, axis=0).all())
        self._expected = expected_body(mattress) if self._has_bed else {}
        self._stack()

    def seen(self, part: str) -> bool:
        """Whether that part has been seen at least once."""
        return part in self._parts

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
        self._held.pop(part, None)
        self._stack()

    def forget(self, part: str) -> None:
        """Take one part as not seen: it has moved."""
        self._parts.pop(part, None)
        self._held.pop(part, None)
        self._stack()

    def nearest_arm(self, position_in_map: np.ndarray) -> str | None:
        """The arm that is nearest to a position (3,), None where none has been seen."""
        arms = [part for part in ARMS if part in self._parts]
        point = np.asarray(position_in_map, float)[None]
        return min(arms, key=lambda part: _from_surface(point, *self._parts[part]), default=None)

    def move_arm(self, part: str, hand_in_map: np.ndarray) -> None:
        """Turn an arm that a hand holds about its shoulder, to where the hand (3,) is now.

        The first call says where it is held.  A part that has not been seen is left out.
        """
        if part not in self._parts:
            return
        hand, (points, radius) = np.array(hand_in_map, float), self._parts[part]
        chain, taken_at, was_at = self._held.get(part, (points, hand, None))
        if was_at is not None and (hand == was_at).all():
            return
        self._held[part] = chain, taken_at, hand
        self._parts[part] = (_turned(chain, taken_at, hand), radius)
        self._stack()

    def distance(self, positions_in_map: np.ndarray) -> np.ndarray:
        """Distance (k,) from each position (k, 3) to where the person is or may be [m]; 0 inside."""
        points = np.asarray(positions_in_map, float).reshape(-1, 1, 3)
        return self.link_distance(points.repeat(2, axis=1), np.zeros(len(points)))

    def link_distance(self, ends_in_map: np.ndarray, radii: np.ndarray) -> np.ndarray:
        """Distance (r,) from each capsule, ends (r, 2, 3) and radii (r,), to where the person is or may be [m]."""
        ends, radii = np.ascontiguousarray(ends_in_map, float), np.ascontiguousarray(radii, float)
        nearest = nearest_gaps(ends, radii, self.ends, self.radii)
        if self._has_bed and not self.known:
            nearest = np.minimum(nearest, box_distances(ends, self._bed) - radii)
        return np.maximum(nearest, 0.0)

    def gaps(self, ends_in_map: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Between capsules, ends (r, 2, 3) and radii (r,) [m], and the person's: negative inside.

        Returns:
            (r, m) gaps between the surfaces [m] and (r, m, 3) directions from the person to the capsule.
        """
        ends, radii = np.ascontiguousarray(ends_in_map, float), np.ascontiguousarray(radii, float)
        return capsule_gaps(ends, radii, self.ends, self.radii)

    def _stack(self) -> None:
        """All chains as one array of capsules; what has not been seen is where it is expected."""
        self.known = WHOLE in self._parts or all(part in self._parts for part in PARTS)
        parts = dict(self._parts) if WHOLE in self._parts else {**self._expected, **self._parts}
        chains = {name: (_links(points), radius) for name, (points, radius) in parts.items()}
        self.names = tuple(name for name, (links, _) in chains.items() for _ in links)
        self.ends = np.concatenate([np.zeros((0, 2, 3)), *(links for links, _ in chains.values())])
        self.radii = np.array([radius for links, radius in chains.values() for _ in links])


def expected_body(bed: np.ndarray) -> dict[str, tuple[np.ndarray, float]]:
    """Chains of points with a radius [m]: head, trunk and legs of an adult in the middle of a bed (2, 3)."""
    x, y = bed[:, :2].mean(axis=0)
    shoulders = y - PERSON.shoulders_headward
    return body_parts(x, shoulders - PERSON.crown_to_shoulder, float(bed[1, 2]))


def body_parts(
    middle: float,
    crown: float,
    mattress: float,
    *,
    scale: float = 1.0,
    front: float = PERSON.front_height,
    breastbone: float | None = None,
) -> dict[str, tuple[np.ndarray, float]]:
    """Head, trunk and legs of a person on the back, as chains of points with a radius [m].

    Args:
        middle: x of the midline in the map [m].
        crown: y of the far end of the head [m].
        mattress: height of the mattress [m].
        scale: body size relative to an adult of 174 cm.
        front: of the trunk, above the mattress [m].
        breastbone: height of the trunk's front on the midline, if it lies lower [m].
    """
    shoulders, radius = crown + PERSON.crown_to_shoulder * scale, front / 2
    level, dip = mattress + radius, front - min(front, front if breastbone is None else breastbone)
    aside = PERSON.trunk_half_width - radius
    hips = shoulders + PERSON.trunk_length
    feet = hips + PERSON.leg_length
    low = shoulders + radius / 2  # the trunk is round below the shoulders
    left, right = middle - aside, middle + aside
    between = (middle, low, level - dip)
    trunk = np.array(((left, hips, level), (left, low, level), between, (right, low, level), (right, hips, level)))
    flat = mattress + PERSON.leg_radius
    spread = PERSON.thigh_half_width * max(scale, 1.0) - PERSON.leg_radius  # by a head that looks small, not narrower
    left, right = middle - spread, middle + spread
    legs = np.array(((left, feet, flat), (left, hips, flat), (right, hips, flat), (right, feet, flat)))
    axis = mattress + PERSON.axis_height
    neck = shoulders - PERSON.neck_length * scale
    head = np.array(((middle, crown + PERSON.head_radius, axis), (middle, neck, axis)))
    return {HEAD: (head, PERSON.head_radius), TRUNK: (trunk, radius), LEGS: (legs, PERSON.leg_radius)}


def _links(points: np.ndarray) -> np.ndarray:
    """The segments (k, 2, 3) of a chain (n, 3); a single point is one without length."""
    links = np.empty((max(len(points) - 1, 1), 2, 3))
    links[:, 0], links[:, 1] = points[: len(links)], points[-len(links) :]
    return links


def distance_to_chain(points: np.ndarray, chain: np.ndarray) -> np.ndarray:
    """Distance (k,) of points (k, 3) from the axis of a chain of points (n, 3) [m]."""
    return segment_distances(np.stack((points, points), axis=1), _links(chain))[0].min(axis=1)


def _from_surface(point: np.ndarray, chain: np.ndarray, radius: float) -> float:
    return float(distance_to_chain(point, chain)[0]) - radius


def _turned(chain: np.ndarray, taken_at: np.ndarray, hand: np.ndarray) -> np.ndarray:
    """A chain turned as one piece about its first point, by as much as what is held has turned."""
    if len(chain) == 1:
        return chain + (hand - taken_at)
    if min(np.linalg.norm(taken_at - chain[0]), np.linalg.norm(hand - chain[0])) < 1e-3:
        return chain
    held = np.vstack((chain[0], taken_at, chain[1:]))
    return np.delete(turned_about_shoulder(held, 1.0, hand), 1, axis=0)

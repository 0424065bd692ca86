"""What a cloth of springs meets: the capsules, balls and boxes of a PyBullet client, and how they move."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compiled import njit

JUMP = 0.02  # farther than this in a step nothing moves: it was put somewhere else [m]


Link = tuple[int, int]  # body and link, -1 for its base


class _Shape(NamedTuple):
    of: Link
    friction: float
    place: np.ndarray  # (3,) in the frame of the link's centre of mass [m]
    axes: np.ndarray  # (3, 3) in that frame
    size: np.ndarray  # length of the axis and radius, or three edges [m]


class Solids:
    """All collision shapes of a client that are capsules, balls or boxes; others are passed through.

    Args:
        client: BulletClient with the bodies.
        per_second: the client's units of time in a second.

    Attributes:
        capsules: (K, 2, 3) ends of their axes [m]; of a ball both are its middle.
        speeds: (K, 2, 3) of these ends [m/s].
        radii: (K,) [m].
        boxes: (B, 15) middle, half edges, and the axes as a matrix row by row [m].
        box_speeds: (B, 6) of the middle [m/s] and of turning [rad/s].
        friction: (K + B,) of each body's own coefficient.
        changed: whether there are others than at the last reading.
    """

    def __init__(self, client: Any, per_second: float) -> None:
        self._client, self._per_second = client, per_second
        self._find()
        self.changed = True

    def read(self, dt: float) -> None:
        """See where everything is, `dt` [s] after the last time."""
        self.changed = self._client.getNumBodies() != self._count
        if self.changed:
            self._find()
            return
        places = self._places()
        follow(places, self._local, self._place_of, dt, self.capsules, self.speeds)
        for n, row in self._moving_boxes:
            self._read_box(n, places[row, :3], matrix(*places[row, 3:]))

    def push(self, given: np.ndarray, dt: float) -> None:
        """Let what cloth gave to each (K + B, 7) act in the next step of `dt` [s], see `touching._share_out`."""
        c, scale = self._client, 1.0 / dt / self._per_second**2
        for row in self._pushed:
            if given[row, 3] > 0.0:
                body, link = self._of[row]
                force, place = given[row, :3] * scale, given[row, 4:] / given[row, 3]
                c.applyExternalForce(body, link, force.tolist(), place.tolist(), c.WORLD_FRAME)

    # -- finding -------------------------------------------------------------------------------------------

    def _find(self) -> None:
        """List all shapes anew; what moves is read at every step from then on."""
        c = self._client
        self._count = c.getNumBodies()
        capsules: list[_Shape] = []
        boxes: list[_Shape] = []
        moving: set[Link] = set()
        for body in (c.getBodyUniqueId(n) for n in range(self._count)):
            for link in range(-1, c.getNumJoints(body)):
                mass, friction = c.getDynamicsInfo(body, link)[:2]
                if mass > 0.0:
                    moving.add((body, link))
                for _, _, kind, size, _, place, turn in c.getCollisionShapeData(body, link):
                    shape = _Shape((body, link), friction, np.array(place), matrix(*turn), np.array(size))
                    if kind == c.GEOM_BOX:
                        boxes.append(shape)
                    elif kind in (c.GEOM_CAPSULE, c.GEOM_SPHERE):
                        ball = kind == c.GEOM_SPHERE
                        capsules.append(shape._replace(size=np.array((0.0, size[0])) if ball else shape.size))
        self._of = [shape.of for shape in (*capsules, *boxes)]
        self.friction = np.array([shape.friction for shape in (*capsules, *boxes)])
        self._pushed = [row for row, of in enumerate(self._of) if of in moving]
        self._links: dict[int, list[int]] = {}
        for body, link in dict.fromkeys(self._of[row] for row in self._pushed):
            self._links.setdefault(body, []).append(link)
        self._place_all(capsules, boxes)

    def _place_all(self, capsules: list[_Shape], boxes: list[_Shape]) -> None:
        rows = {of: n for n, of in enumerate((body, link) for body, links in self._links.items() for link in links)}
        count = len(capsules)
        self._place_of = np.array([rows.get(shape.of, -1) for shape in capsules], np.int64)
        self._moving_boxes = [(n, rows[shape.of]) for n, shape in enumerate(boxes) if shape.of in rows]
        self.radii = np.array([shape.size[1] for shape in capsules])
        self._local = np.empty((count, 2, 3))
        self.capsules, self.speeds = np.empty((count, 2, 3)), np.zeros((count, 2, 3))
        for k, shape in enumerate(capsules):
            half = shape.size[0] / 2 * shape.axes[:, 2]
            self._local[k] = shape.place - half, shape.place + half
            place, turn = self._place(*shape.of)
            self.capsules[k] = place + self._local[k] @ matrix(*turn).T
        self._boxes = boxes
        self.boxes, self.box_speeds = np.empty((len(boxes), 15)), np.zeros((len(boxes), 6))
        for n, shape in enumerate(boxes):
            place, turn = self._place(*shape.of)
            self._read_box(n, np.array(place), matrix(*turn))

    def _read_box(self, n: int, where: np.ndarray, turn: np.ndarray) -> None:
        (body, link), _, local, axes, size = self._boxes[n]
        self.boxes[n] = np.concatenate([where + turn @ local, size / 2, (turn @ axes).ravel()])
        if link < 0:
            speed, turning = self._client.getBaseVelocity(body)
            offset = np.cross(turning, turn @ local)
            self.box_speeds[n] = np.concatenate([np.add(speed, offset), turning]) * self._per_second

    # -- where things are ----------------------------------------------------------------------------------

    def _place(self, body: int, link: int) -> tuple[Any, Any]:
        """Centre of mass and quaternion."""
        c = self._client
        if link < 0:
            return c.getBasePositionAndOrientation(body)
        return c.getLinkState(body, link, computeForwardKinematics=1)[:2]

    def _places(self) -> np.ndarray:
        """(n, 7) centre of mass and quaternion of every body and link that moves, as `_links` has them."""
        out: list[tuple[Any, Any]] = []
        for body, links in self._links.items():
            if -1 in links:
                out += [self._place(body, link) for link in links]
            else:
                out += [state[:2] for state in self._client.getLinkStates(body, links, computeForwardKinematics=1)]
        return np.array([(*place, *turn) for place, turn in out]).reshape(-1, 7)


@njit()
def matrix(x: float, y: float, z: float, w: float) -> np.ndarray:
    """Rotation (3, 3) of a quaternion."""
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )


@njit()
def follow(
    places: np.ndarray, local: np.ndarray, place_of: np.ndarray, dt: float, ends: np.ndarray, speeds: np.ndarray
) -> None:
    """Bring `ends` (K, 2, 3) of capsules to where their bodies have moved in `dt` [s], and tell their `speeds`.

    Args:
        places: (n, 7) position and quaternion of bodies.
        local: (K, 2, 3) ends in their frames.
        place_of: (K,) which of them, -1 for what stands still.
        dt: time since the last call.
        ends: of the axes in the map.
        speeds: of these ends.
    """
    for k in range(len(ends)):
        if place_of[k] < 0:
            continue
        place = places[place_of[k]]
        turn = matrix(place[3], place[4], place[5], place[6])
        far = 0.0
        for e in range(2):
            for d in range(3):
                now = place[d] + turn[d, 0] * local[k, e, 0] + turn[d, 1] * local[k, e, 1] + turn[d, 2] * local[k, e, 2]
                speeds[k, e, d] = (now - ends[k, e, d]) / dt
                far = max(far, abs(now - ends[k, e, d]))
                ends[k, e, d] = now
        if far > JUMP:
            speeds[k] = 0.0

"""What a cloth of springs meets: the capsules, balls and boxes of a PyBullet client, and how they move."""

from __future__ import annotations

from typing import Any

import numpy as np

JUMP = 0.02  # farther than this in a step nothing moves: it was put somewhere else [m]


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
        self._count = -1
        self.changed = True
        self.read(1.0)

    def read(self, dt: float) -> None:
        """See where everything is, `dt` [s] after the last time."""
        self.changed = self._client.getNumBodies() != self._count
        if self.changed:
            self._find()
        before = self.capsules
        places = self._places()
        self.capsules = before.copy()
        for k in self._moving_capsules:
            place, turn = places[self._capsule_of[k]]
            self.capsules[k] = place + self._local[k] @ turn.T
        self.speeds = (self.capsules - before) / dt
        self.speeds[np.abs(self.capsules - before).max(axis=(1, 2), initial=0.0) > JUMP] = 0.0
        if self.changed:
            self.speeds[:] = 0.0
        for n in self._moving_boxes:
            self._read_box(n, places[self._box_of[n]])

    def push(self, given: np.ndarray, dt: float) -> None:
        """Let what cloth gave to each (K + B, 7) act in the next step of `dt` [s], see `touching.share_out`."""
        c, scale = self._client, 1.0 / dt / self._per_second**2
        for row in self._pushed:
            if given[row, 3] > 0.0:
                body, link = self._of[row]
                force, place = given[row, :3] * scale, given[row, 4:] / given[row, 3]
                c.applyExternalForce(body, link, force.tolist(), place.tolist(), c.WORLD_FRAME)

    # -- finding -------------------------------------------------------------------------------------------

    def _find(self) -> None:
        c = self._client
        self._count = c.getNumBodies()
        capsules: list[tuple[tuple[int, int], np.ndarray, float]] = []
        boxes: list[tuple[tuple[int, int], np.ndarray, np.ndarray, np.ndarray]] = []
        own: list[list[float]] = [[], []]
        moving: set[tuple[int, int]] = set()
        for body in (c.getBodyUniqueId(n) for n in range(self._count)):
            for link in range(-1, c.getNumJoints(body)):
                mass, friction = c.getDynamicsInfo(body, link)[:2]
                for _, _, kind, size, _, place, turn in c.getCollisionShapeData(body, link):
                    where, axes = np.array(place), matrix(turn)
                    if kind in (c.GEOM_CAPSULE, c.GEOM_SPHERE):
                        half = size[0] / 2 if kind == c.GEOM_CAPSULE else 0.0
                        ends = where + np.array((-half, half))[:, None] * axes[:, 2]
                        capsules.append(((body, link), ends, size[1] if kind == c.GEOM_CAPSULE else size[0]))
                        own[0].append(friction)
                    elif kind == c.GEOM_BOX:
                        boxes.append(((body, link), where, np.array(size) / 2, axes))
                        own[1].append(friction)
                if mass > 0.0:
                    moving.add((body, link))
        self._capsule_of, self._box_of = [each[0] for each in capsules], [each[0] for each in boxes]
        self._local = np.array([ends for _, ends, _ in capsules]).reshape(-1, 2, 3)
        self._box_local = [each[1:] for each in boxes]
        self.radii = np.array([radius for *_, radius in capsules])
        self.friction = np.array(own[0] + own[1])
        self._moving_capsules = [k for k, of in enumerate(self._capsule_of) if of in moving]
        self._moving_boxes = [n for n, of in enumerate(self._box_of) if of in moving]
        self._of = [*self._capsule_of, *self._box_of]
        self._pushed = [row for row, of in enumerate(self._of) if of in moving]
        self._links: dict[int, list[int]] = {}
        for body, link in dict.fromkeys(of for of in self._of if of in moving):
            self._links.setdefault(body, []).append(link)
        self.capsules = np.empty_like(self._local)
        for k, of in enumerate(self._capsule_of):
            place, turn = self._place(*of)
            self.capsules[k] = place + self._local[k] @ turn.T
        self.boxes, self.box_speeds = np.empty((len(boxes), 15)), np.zeros((len(boxes), 6))
        for n, of in enumerate(self._box_of):
            self._read_box(n, self._place(*of))

    def _read_box(self, n: int, place: tuple[np.ndarray, np.ndarray]) -> None:
        where, turn = place
        local, half, axes = self._box_local[n]
        self.boxes[n] = np.concatenate([where + turn @ local, half, (turn @ axes).ravel()])
        body, link = self._box_of[n]
        if link < 0:
            speed, turning = self._client.getBaseVelocity(body)
            offset = np.cross(turning, turn @ local)
            self.box_speeds[n] = np.concatenate([np.add(speed, offset), turning]) * self._per_second

    # -- where things are ----------------------------------------------------------------------------------

    def _place(self, body: int, link: int) -> tuple[np.ndarray, np.ndarray]:
        c = self._client
        if link < 0:
            place, turn = c.getBasePositionAndOrientation(body)
        else:
            place, turn = c.getLinkState(body, link, computeForwardKinematics=1)[:2]
        return np.array(place), matrix(turn)

    def _places(self) -> dict[tuple[int, int], tuple[np.ndarray, np.ndarray]]:
        """Centre of mass and axes of every body and link that moves."""
        out = {}
        for body, links in self._links.items():
            joined = [link for link in links if link >= 0]
            if len(joined) < len(links):
                out[body, -1] = self._place(body, -1)
            if joined:
                states = self._client.getLinkStates(body, joined, computeForwardKinematics=1)
                for link, state in zip(joined, states, strict=True):
                    out[body, link] = (np.array(state[0]), matrix(state[1]))
        return out


def matrix(turn: tuple[float, float, float, float]) -> np.ndarray:
    """Rotation (3, 3) of a quaternion x, y, z, w."""
    x, y, z, w = turn
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )

"""The force of the gown on the person, by balance, because PyBullet's cloth contacts are no reliable newtons.

What carries the cloth is known exactly: m (a - g) = hands + hook + (bed and person).  The hands and the hook are
measured (`handle.py`), the acceleration of the centre of mass comes from the vertices, so the remaining force is
what bed and person give (FACTS: within 10-15 %).  It is shared out by how many vertices touch each part.
"""

from __future__ import annotations

import numpy as np

from ..compiled import njit
from ..scene.person_spec import ARM_SEGMENTS, PERSON_PARTS, arm_part, part_of
from .person import Person
from .soft_world import GRAVITY

TOUCH = 0.012  # a vertex this near to a surface touches it: twice the collision margin [m]


class ForceBalance:
    """Shares the supporting force of the cloth among the parts of the person.

    Args:
        person: the body.
        mass: of the cloth [kg].
        bed_top: height of the mattress [m].
    """

    def __init__(self, person: Person, mass: float, bed_top: float) -> None:
        self.person, self.mass, self.bed_top = person, mass, bed_top
        self._centres: list[tuple[float, np.ndarray]] = []  # time, centre of mass
        trunk, count = person.trunk, len(ARM_SEGMENTS)
        arms = [arm_part(arm, segment) for arm in range(2) for segment in range(count)]
        self._parts = np.array([*(part_of(name) for name in trunk), *arms])
        self._reach = np.array([*(radius for *_, radius in trunk.values()), *person.radii().ravel()]) + TOUCH
        self._still = len(trunk)  # capsules that do not move; those of the arms come after them
        self._ends = np.zeros((len(self._parts), 2, 3))
        self._ends[: self._still] = [(a, b) for a, b, _ in trunk.values()]

    def parts(
        self, time: float, vertices: np.ndarray, held: np.ndarray, arm_loads: dict[int, np.ndarray]
    ) -> np.ndarray:
        """(k,) force on each of `PERSON_PARTS` [N].

        Args:
            time: world clock [s].
            vertices: (V, 3) of the cloth [m].
            held: (3,) force that hands and hook exert on the cloth [N].
            arm_loads: index of a part -> (3,) force that a hand exerts on it directly [N].
        """
        if not len(vertices):
            return self._direct(np.zeros(len(PERSON_PARTS)), arm_loads)
        if not self._centres or time > self._centres[-1][0]:
            self._centres = [*self._centres[-2:], (time, vertices.mean(axis=0))]
        rest = self.mass * (self._acceleration() + (0.0, 0.0, GRAVITY)) - held
        counts, on_bed = self._touching(vertices)
        total = counts.sum() + on_bed
        force = np.linalg.norm(rest) * counts / total if total else np.zeros(len(PERSON_PARTS))
        return self._direct(force, arm_loads)

    @staticmethod
    def _direct(force: np.ndarray, arm_loads: dict[int, np.ndarray]) -> np.ndarray:
        for part, load in arm_loads.items():
            force[part] += np.linalg.norm(load)
        return force

    def _acceleration(self) -> np.ndarray:
        if len(self._centres) < 3:
            return np.zeros(3)
        (t0, a), (t1, b), (t2, c) = self._centres
        return ((c - b) / (t2 - t1) - (b - a) / (t1 - t0)) / (0.5 * (t2 - t0))

    def _touching(self, vertices: np.ndarray) -> tuple[np.ndarray, int]:
        """How many vertices touch each part, and how many the bed."""
        joints = self.person.arms()
        self._ends[self._still :, 0] = joints[:, :-1].reshape(-1, 3)
        self._ends[self._still :, 1] = joints[:, 1:].reshape(-1, 3)
        counts = np.zeros(len(PERSON_PARTS))
        np.add.at(counts, self._parts, count_touching(vertices, self._ends, self._reach))
        return counts, int((vertices[:, 2] < self.bed_top + TOUCH).sum())


@njit()
def count_touching(points: np.ndarray, ends: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """How many points (n, 3) are nearer to each axis, ends (k, 2, 3), than `reach` (k,) [m]."""
    counts = np.zeros(len(ends), np.int64)
    for k in range(len(ends)):
        ax, ay, az = ends[k, 0]
        dx, dy, dz = ends[k, 1, 0] - ax, ends[k, 1, 1] - ay, ends[k, 1, 2] - az
        square = dx * dx + dy * dy + dz * dz
        for n in range(len(points)):
            x, y, z = points[n, 0] - ax, points[n, 1] - ay, points[n, 2] - az
            share = min(max((x * dx + y * dy + z * dz) / square, 0.0), 1.0)
            x, y, z = x - share * dx, y - share * dy, z - share * dz
            counts[k] += x * x + y * y + z * z < reach[k] * reach[k]
    return counts

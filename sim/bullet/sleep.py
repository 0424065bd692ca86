"""Sleep, as rigid bodies have it: what lies still and is held by nobody waits, and costs no physics."""

from __future__ import annotations

import numpy as np

from .cloth import ClothBody
from .objects import RoomObjects
from .person import Person

SLEEP_MOVE = 0.004  # cloth that moves less than this ... [m]
SLEEP_TIME = 0.4  # ... in this time, and that nobody holds, rests [s]


class Sleep:
    """Of the gown, the person's arms and the objects in a room, together.

    It is also who asks where the gown is, because what sleeps need not be asked: PyBullet takes long to answer.

    Args:
        cloth: the gown.
        person: whose arms they are.
        objects: that a task has added.
        time_step: of the room [s].

    Attributes:
        asleep: nothing moves, and nothing needs a step.
        vertices: (V, 3) of the gown when it was last looked at for this [m].
    """

    def __init__(self, cloth: ClothBody, person: Person, objects: RoomObjects, time_step: float) -> None:
        self._cloth, self._person, self._objects = cloth, person, objects
        self._between = int(SLEEP_TIME / time_step)  # steps
        self.asleep = False
        self._arms = person.arms()
        self.look_anew()

    def look_anew(self) -> None:
        """The gown has been put somewhere else, or has moved before the run."""
        self.vertices, self._looked_at = self._cloth.vertices(), -1

    def vertices_at(self, step: int) -> np.ndarray:
        """(V, 3) of the gown at the present step [m], read-only: the engine is asked once between two steps."""
        if self.asleep:
            return self.vertices
        if self._looked_at != step:
            self._looked_at, self._seen = step, self._cloth.vertices()
        return self._seen

    def due(self, step: int) -> bool:
        """Whether it is time to look whether all lie still."""
        return not self.asleep and step % self._between == 0

    def look(self, step: int, busy: bool) -> None:
        """Fall asleep if nothing has moved since the last look.

        Args:
            step: the present one.
            busy: something is held or touched, or the person moves.
        """
        vertices, arms = self.vertices_at(step), self._person.arms()
        moved = max(float(np.abs(arms - self._arms).max()), self._objects.moved())
        moved = max(moved, float(np.abs(vertices - self.vertices).max(initial=0.0)))
        self.vertices, self._arms = vertices, arms
        self.asleep = not busy and moved < SLEEP_MOVE and step > 0

    def wake(self) -> None:
        """Something moves."""
        self.asleep = False

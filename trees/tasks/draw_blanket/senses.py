"""What `draw_blanket` sees otherwise than the dressing task: the blanket's edge in place of the hung gown."""

from __future__ import annotations

import numpy as np

from ....perception.classical import ClassicalSenses
from ....perception.estimates import GraspPoint
from ....perception.image.cloth_edge import cloth_edge
from ....sim.world import Frame, RoomMap


class BlanketSenses(ClassicalSenses):
    """The classical senses, to which what is taken first is the edge of a blanket."""

    def __init__(self, room: RoomMap, seed: int | np.random.Generator) -> None:
        super().__init__(room, seed)
        self._room = room

    def hang_point(self, frame: Frame) -> GraspPoint:
        """The upper edge, on the side on which the robot stands."""
        return cloth_edge(frame, self._room.bed)

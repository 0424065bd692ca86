"""What `hand_towel` sees otherwise than the dressing task: the towel on its hook in place of the gown."""

from __future__ import annotations

from ....perception.classical import ClassicalSenses
from ....perception.estimates import GraspPoint
from ....perception.image.hung_cloth import hung_cloth
from ....sim.world import Frame


class TowelSenses(ClassicalSenses):
    """The classical senses, to which what is taken first is a hung towel."""

    def hang_point(self, frame: Frame) -> GraspPoint:
        """The towel, a little below its hook."""
        return hung_cloth(frame)

"""What `wipe_forearm` sees otherwise than the dressing task: the cloth on its table in place of the hung gown."""

from __future__ import annotations

from ....perception.classical import ClassicalSenses
from ....perception.estimates import GraspPoint
from ....perception.image.folded_cloth import folded_cloth
from ....sim.world import Frame


class WashingSenses(ClassicalSenses):
    """The classical senses, to which what is taken first is a folded cloth."""

    def hang_point(self, frame: Frame) -> GraspPoint:
        """The folded cloth, from above."""
        return folded_cloth(frame)

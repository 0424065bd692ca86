"""The rehearsal of `draw_blanket`: its edge is seen where it lies, or where a hand has let go of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import Command, Frame, GripperOpening, World
from ....skills.scripted.rehearsal import RehearsalWorld
from ....skills.scripted.scripted_senses import ScriptedSenses


@dataclass(frozen=True, kw_only=True)
class BlanketTuning(Quantities):
    """Where the edge is seen."""

    aside: float = quantity(0.22, "m", "from the middle of the bed", "choice: beside the legs")
    footward: float = quantity(0.24, "m", "from the middle of the bed, at first", "choice: over the thighs")
    height: float = quantity(0.70, "m", "above the floor", "choice: cloth between legs and mattress")


BLANKET = BlanketTuning()


class BlanketWorld(RehearsalWorld):
    """The rehearsal's world, where a blanket's edge stays where a hand lets go of it.

    Attributes:
        edge: by the sign of x, y of the edge on that side of the bed [m].
    """

    def __init__(self, seed: int = 0) -> None:
        super().__init__(seed)
        self.edge = {-1.0: BLANKET.footward, 1.0: BLANKET.footward}

    def send(self, command: Command) -> Command:
        """As the rehearsal's, and an opening hand lets go of the edge."""
        if isinstance(command, GripperOpening) and command.side in self._taken:
            hand = self._hand(command.side)
            self.edge[float(np.sign(hand[0]))] = float(hand[1])
        return super().send(command)


class BlanketScript(ScriptedSenses):
    """Sees the edge on the side of the bed on which the robot stands."""

    def __init__(self, world: BlanketWorld) -> None:
        super().__init__(world)
        self._blanket = world

    def hang_point(self, frame: Frame) -> GraspPoint:
        """Where it lies by now."""
        side = float(np.sign(self._blanket.observe().pose_base_in_map[0]))
        return replace(
            super().hang_point(frame),
            position_in_map=np.array((side * BLANKET.aside, self._blanket.edge[side], BLANKET.height)),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """A world to rehearse the task on, and what is seen there."""
    world = BlanketWorld(seed)
    return world, BlanketScript(world)

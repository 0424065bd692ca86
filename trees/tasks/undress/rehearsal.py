"""The rehearsal of `undress`: a sleeve is on its arm until a hand lets go of its seam beyond the fingertips."""

from __future__ import annotations

import numpy as np

from ....perception.errors import PerceptionFailure, Problem
from ....perception.estimates import ChestCover, Cover, GraspPoint, WornSleeve
from ....sim.world import SIDES, Command, Frame, GripperOpening, Side, World
from ....skills.geometry.stances import HEADWARD
from ....skills.scripted.rehearsal import RehearsalWorld
from ....skills.scripted.scripted_person import lying_arm
from ....skills.scripted.scripted_senses import ScriptedSenses


class WornWorld(RehearsalWorld):
    """The rehearsal's world, whose gown is worn.

    Attributes:
        worn: sides whose sleeve is on its arm.
    """

    def __init__(self, seed: int = 0) -> None:
        super().__init__(seed)
        self.worn: set[Side] = set(SIDES)

    def send(self, command: Command) -> Command:
        """As the rehearsal's, and a hand that opens beyond the fingertips has drawn the sleeve off."""
        if isinstance(command, GripperOpening) and command.side in self._taken:
            hand = self._hand(command.side)
            side = min(SIDES, key=lambda each: float(np.linalg.norm(hand - lying_arm(each)[3])))
            if (hand - lying_arm(side)[3]) @ HEADWARD < 0.0:
                self.worn.discard(side)
        return super().send(command)


class WornScript(ScriptedSenses):
    """Sees the sleeves and the gown on the trunk, as long as they are there."""

    def __init__(self, world: WornWorld) -> None:
        super().__init__(world)
        self._worn = world.worn

    def shoulder_seam(self, frame: Frame, *, side: Side, shoulders_in_map: np.ndarray) -> GraspPoint:
        """At the shoulder of a worn sleeve."""
        if side not in self._worn:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"seam over the {side} shoulder")
        return super().shoulder_seam(frame, side=side, shoulders_in_map=shoulders_in_map)

    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """Round the arm, of a worn one."""
        if side not in self._worn:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
        return super().worn_sleeve(frame, side=side, arm_in_map=arm_in_map)

    def skin_cover(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """None: the sleeves are short."""
        return Cover(stamp=frame.stamp, confidence=0.9, share=0.0)

    def chest_cover(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestCover:
        """All of it, until both arms are bare."""
        return ChestCover(stamp=frame.stamp, confidence=0.9, share=float(bool(self._worn)), outside=1.0)


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """A world to rehearse the task on, and what is seen there."""
    world = WornWorld(seed)
    return world, WornScript(world)

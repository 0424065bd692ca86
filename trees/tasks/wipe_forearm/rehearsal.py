"""The rehearsal of `wipe_forearm`: a cloth is seen on a table, and an arm is felt through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Frame, Side, World
from ....skills.geometry.arm_path import ArmPath
from ....skills.scripted.rehearsal import RehearsalWorld
from ....skills.scripted.scripted_person import lying_arm
from ....skills.scripted.scripted_senses import ScriptedSenses


@dataclass(frozen=True, kw_only=True)
class WashingTuning(Quantities):
    """What is felt through the cloth, and where it stands."""

    place: tuple[float, float, float] = quantity((2.7, 0.55, 0.77), "m", "of the cloth", "choice: on the table")
    reach: float = quantity(
        0.09, "m", "from the fingertips to an arm's axis, at which the cloth touches", "choice: pad"
    )
    stiffness: float = quantity(500.0, "N/m", "of the cloth", "choice: wet folded terry cloth")


WASHING = WashingTuning()


class WashingWorld(RehearsalWorld):
    """The rehearsal's world, where a hand that holds the cloth feels the arm below it."""

    def held_back(self, side: Side) -> np.ndarray:
        """As the rehearsal's, and the arm's push."""
        hand = self._hand_poses()[SIDES.index(side), :3, 3]
        deep = 0.0
        for whose in SIDES:
            path = ArmPath(lying_arm(whose) + self.person_offset)
            away = hand - path.point(path.coordinate_of(hand))
            deep = max(deep, WASHING.reach - float(np.linalg.norm(away)))
        return super().held_back(side) + (0.0, 0.0, WASHING.stiffness * deep)


class WashingScript(ScriptedSenses):
    """Sees the cloth on its table."""

    def hang_point(self, frame: Frame) -> GraspPoint:
        """Always there."""
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.9,
            target="near_hang",
            position_in_map=np.array(WASHING.place),
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )


def scripted(seed: int) -> tuple[World, ScriptedSenses]:
    """A world to rehearse the task on, and what is seen there."""
    world = WashingWorld(seed)
    return world, WashingScript(world)

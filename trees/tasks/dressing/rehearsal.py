"""The rehearsal of `dressing`: a sleeve is on its arm once a hand was seen with it at the shoulder."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from ....perception.errors import PerceptionFailure, Problem
from ....perception.estimates import ArmPosture, WornSleeve
from ....sim.mechanics.robot_model import RobotModel
from ....sim.world import SIDES, Frame, Side, World
from ....skills.scripted.rehearsal import RehearsalWorld
from ....skills.scripted.scripted_person import lying_arm
from ....skills.scripted.scripted_senses import Proprioception, ScriptedSenses

AT_SHOULDER = 0.25  # from a shoulder, within which a strap that is held has drawn the sleeve up [m]
BESIDE_HAND = 0.2  # from the fingertips, within which the sleeve of a strap that is held is off the arm [m]
WORN = ("gown_worn", "gown_dressed")  # initial states
STRAP = 0.02  # between the fingertips, at most, of a hand that holds a strap and not an arm [m]


@runtime_checkable
class _Begins(Protocol):
    """A world that says in which state its run began."""

    @property
    def initial_state(self) -> str: ...


class GownScript(ScriptedSenses):
    """Sees a sleeve on its arm where it has been drawn up, or where the run began so.

    Args:
        world: says where the robot's hands are.
    """

    def __init__(self, world: Proprioception) -> None:
        super().__init__(world)
        self._drawn_up: set[Side] = set()

    def arm(
        self, frame: Frame, *, side: Side, grip_in_map: np.ndarray | None = None, arm_coordinate: float = 1.0
    ) -> ArmPosture:
        """At rest; and where a strap is held along it."""
        seen = self._world.observe()
        shoulder, _, _, fingertip = lying_arm(side)
        for place, opening in zip(seen.pose_hand_in_map[:, :3, 3], seen.gripper_opening, strict=True):
            if opening > STRAP:
                continue
            if np.linalg.norm(place - shoulder) < AT_SHOULDER:
                self._drawn_up.add(side)
            elif np.linalg.norm(place - fingertip) < BESIDE_HAND:
                self._drawn_up.discard(side)
        return super().arm(frame, side=side, grip_in_map=grip_in_map, arm_coordinate=arm_coordinate)

    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """At the shoulder of an arm that is dressed."""
        if side not in self._worn():
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
        return super().worn_sleeve(frame, side=side, arm_in_map=arm_in_map)

    def _worn(self) -> set[Side]:
        begun = self._world.initial_state if isinstance(self._world, _Begins) else None
        return set(SIDES) if begun in WORN else self._drawn_up


def scripted(seed: int, robot: RobotModel | None = None) -> tuple[World, ScriptedSenses]:
    """The world on which the task is rehearsed: every grasp succeeds, and what is seen is made up."""
    world = RehearsalWorld(seed, robot=robot)
    return world, GownScript(world)

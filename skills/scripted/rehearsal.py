"""A dressing without physics: fingers meet cloth, or an arm where one lies; the gown follows as light cloth does.

What is seen comes from a script too (`scripted_senses`).  Every grasp succeeds, so that a whole task
can be rehearsed, and every recovery and safe branch reached by injecting faults; how cloth behaves is not shown.
"""

from __future__ import annotations

import itertools

import numpy as np

from ...sim.robot import model
from ...sim.robot.kinematics import default_kinematics
from ...sim.scene.initial_state import InitialState
from ...sim.scene.scene import room_map
from ...sim.scripted.world import ScriptedWorld
from ...sim.world import SIDES, Command, GripperOpening, Observation, Side
from .scripted_person import LYING, mirrored
from .scripted_senses import ScriptedSenses

CLOSING = 0.03  # a hand sent to less than this takes hold [m]
NEAR_ARM = 0.10  # of an arm's axis: fingers that close within it hold the arm [m]
ARM, CLOTH = 0.07, 0.002  # what the fingers then have between them [m]
WEIGHT = 1.4  # of what hangs on a hand [N]
SPRING, DRAG = 100.0, 1.1  # a hand that draws is held back by so much per way [N/m], and never by more [N]


class RehearsalWorld(ScriptedWorld):
    """The scripted world in the map of the simulated room, with something to hold wherever a hand closes.

    Args:
        seed: of the sensor noise.

    Attributes:
        initial_states: names of the states in which a run may begin.
    """

    initial_states = tuple(InitialState)

    def __init__(self, seed: int = 0) -> None:
        super().__init__(seed=seed, room=room_map(), kinematics=default_kinematics(), arm_positions=model.READY)
        self._taken: dict[Side, np.ndarray] = {}  # where a hand has taken hold [m]

    def set_initial_state(self, name: str) -> None:
        """Begin with the gown in both hands, or with empty ones wherever else it is said to be.

        Raises:
            WorldError: there is no such state.
        """
        if InitialState.named(name) == InitialState.GOWN_IN_HANDS:
            self._opening[:] = CLOTH
            for side in SIDES:
                self.send(GripperOpening(side=side, opening=0.0))

    def send(self, command: Command) -> Command:
        """Start a command; a closing hand finds something, an opening one loses it."""
        if isinstance(command, GripperOpening):
            if command.opening >= CLOSING:
                self._taken.pop(command.side, None)
                self.between_fingers[command.side] = 0.0
            elif command.side not in self._taken:
                hand = self._taken[command.side] = self._hand(command.side)
                arms = [mirrored(LYING, side) for side in SIDES]
                away = min(_distance(hand, *limb) for arm in arms for limb in itertools.pairwise(arm))
                self.between_fingers[command.side] = ARM if away < NEAR_ARM else CLOTH
        return super().send(command)

    def observe(self) -> Observation:
        """The scripted world's senses, with the load of what the hands hold."""
        for side in SIDES:
            self.load[side] = np.zeros(6)
            if side in self._taken and self.between_fingers[side] > 0.0:
                drag = SPRING * (self._taken[side] - self._hand(side))
                self.load[side][:3] = drag * min(1.0, DRAG / max(float(np.linalg.norm(drag)), 1e-9))
                self.load[side][2] -= WEIGHT
        return super().observe()

    def _hand(self, side: Side) -> np.ndarray:
        return self.kinematics.pose_hand_in_map(side, self._q[SIDES.index(side)], self._base)[:3, 3].copy()


def _distance(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    """Of a point from a segment [m]."""
    along = end - start
    share = np.clip((point - start) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(start + share * along - point))


def rehearsal(seed: int) -> tuple[RehearsalWorld, ScriptedSenses]:
    """A world to rehearse the dressing task on, and what is seen there."""
    world = RehearsalWorld(seed)
    return world, ScriptedSenses(world)

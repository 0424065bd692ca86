"""What skills have said that the hands hold, and which of the person's arms goes with a hand that holds one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...sim.world import SIDES, GripperOpening, Observation, Side
from ...skills.core.context import Grip
from ...skills.geometry.person_zone import PersonZone

OPENED = 0.01  # [m] a command that opens the fingers by this much lets go


class DeclaredGrips:
    """By hand, what it was last said to hold.

    Args:
        zone: where the person is; arms in a hand are moved there.
    """

    def __init__(self, zone: PersonZone) -> None:
        self._zone = zone
        self._what: dict[Side, Grip] = {"left": "nothing", "right": "nothing"}
        self._arms: dict[Side, str] = {}

    @property
    def arms(self) -> Mapping[Side, str]:
        """By hand, the person's arm that it holds, as the zone names it."""
        return self._arms

    def of(self, side: Side) -> Grip:
        """What a hand was said to hold."""
        return self._what[side]

    def holds_arm(self, side: Side) -> bool:
        """Whether a hand was said to hold an arm."""
        return self._what[side] == "arm"

    def declare(self, side: Side, what: Grip) -> None:
        """Say what a hand holds; which arm that is, `find_arm` says."""
        self._what[side] = what
        self._arms.pop(side, None)

    def find_arm(self, side: Side, hand_in_map: np.ndarray) -> None:
        """Take the arm nearest to a hand (3,) [m] for the one it holds, if it holds one."""
        arm = self._zone.nearest_arm(hand_in_map)
        if self.holds_arm(side) and arm is not None:
            self._arms[side] = arm

    def carry(self, seen: Observation) -> None:
        """Move the arms that hands hold along with them: they go with the hand, seen or not."""
        for side, arm in self._arms.items():
            self._zone.move_arm(arm, seen.pose_hand_in_map[SIDES.index(side), :3, 3])

    def told(self, command: GripperOpening, seen: Observation) -> None:
        """Fingers that are sent apart let go."""
        if command.opening > seen.gripper_opening[SIDES.index(command.side)] + OPENED:
            self._what[command.side] = "nothing"

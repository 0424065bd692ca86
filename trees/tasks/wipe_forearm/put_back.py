"""Put what was taken from a table back to where it stood."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.control.base import stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import move_hands
from ....skills.control.pinch import PINCH, back_off, grasp_poses
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class PutBackTuning(Quantities):
    """Numbers of `PutBack`."""

    above: float = quantity(0.12, "m", "of the hand over the place before it goes down", "choice: clear of the table")
    speed: float = quantity(0.3, "m/s", "of the hand until then", "choice: the cloth does not swing")
    down: Carry = field(default_factory=lambda: Carry(speed=0.05, touch_load=1.5, tolerance=0.004))


class PutBack(Skill):
    """Stands where the place is within reach, lowers what the hand holds until it stands, opens and draws back.

    It fails where the place is out of reach, or where a command is lost.
    """

    hand = Input(Side, doc="hand of the robot that holds it")
    grasp = Input(GraspPoint, unit="m, map", doc="where it was taken")
    tuning = Input(PutBackTuning, default=PutBackTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.PATH_BLOCKED, Reason.TIMEOUT, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Stand, over it, down, open, up."""
        tuning, point = self.tuning, self.grasp
        self.note("puts the cloth back")
        yield from stand_for(self, self.hand, point.position_in_map)
        way = point.position_in_map, point.approach_in_map, point.closing_in_map
        above, inside = grasp_poses(self, self.hand, *way, standoff=tuning.above)
        yield from move_hands(self, {self.hand: above}, speed=tuning.speed, way="any")
        yield from carry(self, self.hand, inside[:3, 3], tuning.down)
        yield from open_gripper(self, self.hand)
        yield from back_off(self, self.hand, PINCH.standoff)

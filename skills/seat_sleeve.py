"""Draw the armhole of a worn sleeve up to the shoulder by its front edge."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import chest_top, watch_arm
from .belief.shoulders import drawn_up
from .control.carry import Carry, carry
from .control.fingers import open_gripper
from .control.hands import hand_now
from .control.take_from_above import FromAbove, take_from_above
from .control.withdraw import withdraw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD, outwards


@dataclass(frozen=True, kw_only=True)
class SeatSleeveTuning(Quantities):
    """Numbers of `SeatSleeve`."""

    grasp: FromAbove = field(default_factory=FromAbove)
    lift: float = quantity(0.04, "m", "of the cloth off the arm before it is drawn", "choice: the hand clears the arm")
    drawn_to: tuple[float, float, float] = quantity(
        (0.05, 0.02, 0.27),
        "m",
        "inwards, headward and up from the shoulder, where the armhole's front edge is drawn to: until it is taut, and "
        "its far side, below the arm, comes along",
        "measured with ideal hands: let go of 0.15 m up instead, an armhole went back to 0.63 (103), 0.70 like this, "
        "0.76 drawn 0.06 m headward; but that took the neckline over the face for 27 s (0)",
    )
    laid_at: tuple[float, float, float] = quantity(
        (0.05, 0.02, 0.13),
        "m",
        "inwards, headward and up from the shoulder, where that edge is laid down and let go of",
        "measured: let go of where it is taut, it springs back by 0.1 more",
    )
    laying_speed: float = quantity(0.06, "m/s", "of the hand on its way down", "choice: it may meet the chest")
    above_chest: float = quantity(
        0.01,
        "m",
        "of the hand there, above the front of the chest, at least",
        "measured: at 0.10 m above the shoulder and 0.10 m inwards, below the front of the chest, fingers met the "
        "trunk with 64 to 85 N as they opened or before (101, 102, 105); from higher, it slides back farther",
    )
    carry: Carry = field(default_factory=lambda: Carry(max_load=8.0))
    withdrawal: float = quantity(0.12, "m", "by which the open hand is drawn back", "choice: clear of the sleeve")


class SeatSleeve(Skill):
    """Takes the armhole by its front edge, draws it up and to the shoulder until it is taut, and lays it down there.

    Drawn by the strap, an armhole is drawn long, and goes back as the strap is let go of: the sleeve resists being
    bent along the arm, and its far side stays where it lies.  Its front edge takes the whole armhole along.  The arm
    has to lie.  The hand ends open and drawn back, after a missed grasp too.
    """

    side = Input(Side, doc="arm of the person that wears the sleeve")
    hand = Input(Side, doc="the robot's hand that draws")
    tuning = Input(SeatSleeveTuning, default=SeatSleeveTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Draw as long as the person does not move."""
        yield from while_person_rests(self, self._seat())

    def _seat(self) -> Iterator[None]:
        """Look, take, lift, draw, lay down, let go."""
        tuning = self.tuning
        self.note(f"takes the front of the {self.side} armhole")
        arm = watch_arm(self, self.side).points_in_map
        point = self.context.senses.armhole_front(self.world.look("head"), side=self.side, arm_in_map=arm)
        yield from take_from_above(self, self.hand, point, self.side, tuning.grasp)
        self.note(f"draws the {self.side} armhole to the shoulder")
        yield from carry(self, self.hand, hand_now(self, self.hand)[:3, 3] + tuning.lift * UP, tuning.carry)
        yield from carry(self, self.hand, self._place(arm[0], tuning.drawn_to), tuning.carry)
        laid = self._place(arm[0], tuning.laid_at)
        laid[2] = max(laid[2], chest_top(self) + tuning.above_chest)
        yield from carry(self, self.hand, laid, tuning.carry, tuning.laying_speed)
        drawn_up(self).add(self.side)
        yield from open_gripper(self, self.hand, tuning.grasp.opening)  # wider, a finger would come down to the chest
        yield from withdraw(self, [self.hand], tuning.withdrawal)

    def _place(self, shoulder: np.ndarray, place: tuple[float, float, float]) -> np.ndarray:
        """(3,) in the map of a place inwards, headward and up from the shoulder [m]."""
        inward, headward, up = place
        return shoulder - inward * outwards(self.side) + headward * HEADWARD + up * UP

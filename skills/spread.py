"""Lift the collar by its middle and lay it down on the midline, below the throat."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_motion import while_person_rests
from .belief.shoulders import between_shoulders, look_at_collar, off_middle
from .control.carry import Carry, carry
from .control.fingers import open_gripper
from .control.hands import hand_now
from .control.pinch import pinch_or_back_off, reach_in
from .control.withdraw import withdraw
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .geometry.from_above import from_above
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class SpreadTuning(Quantities):
    """Numbers of `Spread`."""

    footward: float = quantity(
        0.03, "m", "of the collar's middle from the line of the shoulders", "choice: below the throat, above the chest"
    )
    lies_well: float = quantity(
        0.05, "m", "from there, aside, within which the collar is left as it is", "choice: 2 cm of the 7 cm allowed"
    )
    lies_along: tuple[float, float] = quantity(
        (-0.06, 0.07),
        "m",
        "headward of the line of the shoulders, within which the collar is left as it is",
        "choice: 2 and 3 cm of the 8 and 10 cm that are allowed",
    )
    max_tilt: float = quantity(
        float(np.deg2rad(35.0)), "rad", "of the approach off the vertical", "choice: the hand comes from above"
    )
    opening: float = quantity(
        0.05, "m", "of the fingers on the way in", "choice: wider, one goes down beside the chest"
    )
    depth: float = quantity(0.0, "m", "of the fingertips beyond the cloth", "choice: the body is right below it")
    lift: float = quantity(
        0.10,
        "m",
        "of the collar off the body before it is carried",
        "measured: drawn along the body instead, it sprang back to where it lay; lifted by 0.10 to 0.18 m, it stayed",
    )
    below: tuple[float, ...] = quantity(
        (0.05, 0.08, 0.11, 0.15, 0.19),
        "m",
        "footward of the collar's middle, where the cloth is grasped, tried one after the other",
        "measured: at the middle itself the neck was in the hand's way in 5 of 6 whole runs; on a state of 105 a "
        "collar 14 cm headward came to within 4 cm of its place by any of 0.05, 0.11, 0.15 and 0.19",
    )
    beyond: float = quantity(
        0.09,
        "m",
        "by which the collar is carried beyond its place, and then drawn back along the body",
        "measured: let go of at its place, it sprang back by 6 to 16 cm; drawn back to it, by less than 3 cm",
    )
    springs_back: float = quantity(
        0.06,
        "m",
        "across the body, of a collar that was brought to the midline and let go of",
        "measured: 0.03 to 0.09 m in four spreads on 102 and 105",
    )
    laid_height: float = quantity(
        0.02,
        "m",
        "of the hand that draws the collar back, above where it took it",
        "measured: lower, it met the chest beside the breastbone with 120 N (101)",
    )
    laying_speed: float = quantity(0.03, "m/s", "of the hand on its way down", "choice: it may meet the chest")
    carry: Carry = field(default_factory=Carry)
    withdrawal: float = quantity(0.12, "m", "by which the open hand is drawn back", "choice: clear of the collar")


class Spread(Skill):
    """Looks where the middle of the neckline lies, and brings it over the breastbone where it does not lie there.

    A sleeve that is drawn on takes the collar along, to its side or up to the throat; the slack then hides in a fold at
    one shoulder.  Lifted by the cloth below its middle, carried past the midline and drawn back to it, the collar
    shares it between both.  A collar that lies well is left alone.  The hand ends open and drawn back, after a missed
    grasp too.
    """

    side = Input(Side, doc="side of the bed on which the robot stands")
    hand = Input(Side, doc="the robot's hand that carries the collar")
    tuning = Input(SpreadTuning, default=SpreadTuning(), doc="numbers of this skill")
    grasp = Output(GraspPoint, unit="m, map", doc="where the middle of the collar was seen")
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
        """Bring the collar to the middle as long as the person does not move."""
        yield from while_person_rests(self, self._centre())

    def _centre(self) -> Iterator[None]:
        """Look, take, lift, carry, lay down, let go."""
        tuning = self.tuning
        self.note("looks where the collar lies")
        middle = between_shoulders(self)
        point = look_at_collar(self, middle)
        aside, ahead = off_middle(point.position_in_map, middle)
        self.note(f"the collar's middle is {aside * 100:.0f} cm aside, {ahead * 100:.0f} cm headward of the shoulders")
        self.grasp = point
        lowest, highest = tuning.lies_along
        if abs(aside) < tuning.lies_well and lowest < ahead < highest:
            yield
            return
        yield from self._take(middle)
        low = hand_now(self, self.hand)[:3, 3]
        way = np.append((middle - tuning.footward * HEADWARD - point.position_in_map)[:2], 0.0)
        if abs(aside) >= tuning.lies_well:
            way[0] -= np.copysign(tuning.springs_back, aside)
        past = low + way + tuning.beyond * unit(way)
        self.note("carries the collar to the midline")
        yield from carry(self, self.hand, low + tuning.lift * UP, tuning.carry)
        yield from carry(self, self.hand, past + tuning.lift * UP, tuning.carry)
        laid = low + tuning.laid_height * UP
        down = np.append(hand_now(self, self.hand)[:2, 3], laid[2])
        yield from carry(self, self.hand, down, tuning.carry, tuning.laying_speed)
        yield from carry(self, self.hand, laid + way, tuning.carry)
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], tuning.withdrawal)

    def _take(self, middle: np.ndarray) -> Iterator[None]:
        """Grasp the cloth below the collar's middle, as near to it as the hand gets."""
        tuning, tries = self.tuning, Tries(MotionError, PerceptionFailure)
        for below in tuning.below:
            with tries:
                point = look_at_collar(self, middle, below)
                approach = from_above(point.approach_in_map, outwards(self.side), tuning.max_tilt)
                place, closing = point.position_in_map, point.closing_in_map
                yield from reach_in(
                    self, self.hand, place, approach, closing, opening=tuning.opening, depth=tuning.depth
                )
                break
        else:
            raise tries.last
        yield from pinch_or_back_off(self, self.hand)

"""Lift the collar by the cloth below its middle and lay it down near the midline, below the throat."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import GraspPoint
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import chest_top
from .belief.shoulders import between_shoulders, look_at_collar, off_middle
from .control.carry import Carry, carry
from .control.fingers import let_cloth_go
from .control.hands import hand_now
from .control.head import look_towards
from .control.take_from_above import FromAbove, take_from_above
from .control.withdraw import withdraw
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class SpreadTuning(Quantities):
    """Numbers of `Spread`."""

    lies_well: float = quantity(
        0.03,
        "m",
        "aside of the midline, within which the collar is left as it is",
        "choice: 4 cm of the 7 cm allowed, as it is seen to 4 cm",
    )
    lies_along: tuple[float, float] = quantity(
        (-0.05, 0.06),
        "m",
        "headward of the line of the shoulders, within which the collar is left as it is",
        "choice: 0.10 m headward and 0.08 m footward are allowed, and it is seen 0.024 m footward of where it lies; "
        "brought nearer without need, it took the right sleeve down by 0.02 to 0.05 (0, 143, 145)",
    )
    told: float = quantity(
        0.80,
        "1",
        "of the neckline, by its area, below which it is laid anew however near to its place it looks",
        "measured: with less, it is seen up to 0.07 m nearer to the middle than it lies (176 to 181)",
    )
    brought_to: tuple[float, float] = quantity(
        (0.01, 0.05),
        "m",
        "aside of the midline, and, of one that lies along the body, off the line of the shoulders towards the other "
        "side, to which it is brought",
        "measured: 44 times from about 0.10 m headward (0, 145 to 158): let go of 0.024 m or more beyond the line, it "
        "came to lie within 0.05 m of it 10 times of 16, less far beyond 7 times of 22, short of it once of 6; the "
        "right sleeve comes down by 0.04 on average, whether the collar stays or not",
    )
    grasp: FromAbove = field(default_factory=lambda: FromAbove(speed=0.2))
    lift: float = quantity(
        0.10,
        "m",
        "of the collar off the body before it is carried",
        "measured: drawn along the body instead, it sprang back to where it lay; lifted by 0.10 to 0.18 m, it stayed",
    )
    grasped: tuple[tuple[float, float], ...] = quantity(
        ((0.08, 0.05), (0.08, 0.10), (0.08, 0.15), (0.0, 0.05), (0.0, 0.08), (0.0, 0.11), (0.0, 0.15), (0.0, 0.19)),
        "m",
        "towards the midline and footward from the collar's middle, where the cloth is grasped, tried in turn",
        "measured: at the middle itself the neck was in the hand's way in 5 of 6 whole runs; right below a collar that "
        "lay 0.2 m aside no cloth was seen (105, 107), and taken there it came 0.04 m nearer, taken 0.08 m towards the "
        "midline 0.19 m",
    )
    beyond: float = quantity(
        0.05,
        "m",
        "by which the collar is carried beyond its place, and then drawn back along the body",
        "measured: let go of at its place, it sprang back by 6 to 16 cm, drawn back to it, by less than 3 cm; carried "
        "0.09 m beyond, it took the far sleeve down by 0.05 (101, 102)",
    )
    laid_height: float = quantity(
        0.02,
        "m",
        "of the hand that draws the collar back, above where it took it",
        "measured: lower, it met the chest beside the breastbone with 120 N (101)",
    )
    off_chest: float = quantity(
        0.012,
        "m",
        "of that hand above the front of the chest, at least",
        "measured: let down to where cloth had been taken, lower at the flank, it met the chest with 74 and 81 N "
        "(162, 163)",
    )
    laying_speed: float = quantity(0.03, "m/s", "of the hand on its way down", "choice: it may meet the chest")
    carry: Carry = field(default_factory=Carry)
    withdrawal: float = quantity(0.12, "m", "by which the open hand is drawn back", "choice: clear of the collar")


class Spread(Skill):
    """Looks where the middle of the neckline lies, and brings it over the breastbone, no farther than it has to.

    A sleeve that is drawn on takes the collar along, to its side or up to the throat; the slack then hides in a fold at
    one shoulder.  Lifted by the cloth below its middle, carried past its place and drawn back to it, the collar
    shares it between both.  The hand on its side carries it, or the other one where that does not get there.  A collar
    that lies well, as far as enough of it shows to tell, is left alone.  The robot stands at the
    head of the bed; the hand ends open and drawn back, after a missed grasp too.
    """

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
        yield from look_towards(self, middle)
        point = look_at_collar(self, middle)
        aside, ahead = off_middle(point.position_in_map, middle)
        self.note(f"the collar's middle is {aside * 100:.0f} cm aside, {ahead * 100:.0f} cm headward of the shoulders")
        self.grasp = point
        lowest, highest = tuning.lies_along
        lies_well, lies_along = abs(aside) < tuning.lies_well, lowest < ahead < highest
        told = point.confidence >= tuning.told
        if lies_well and lies_along and told:
            yield
            return
        aside_to, ahead_to = np.copysign(tuning.brought_to, (aside, -ahead))
        tries = Tries(MotionError, PerceptionFailure)
        places = self._places(middle, aside, tries)
        hand = yield from self._take(SIDES if aside < 0.0 else SIDES[::-1], places, tries)
        low = hand_now(self, hand)[:3, 3]
        way = np.zeros(3)
        if not lies_well:
            way[0] = aside_to - aside
        elif not told:  # farther on that side than it looks, if anything
            way[0] = -aside_to
        if not lies_along:
            way += (ahead_to - ahead) * HEADWARD
        past = low + way + tuning.beyond * unit(way)
        self.note("carries the collar to the midline")
        yield from carry(self, hand, low + tuning.lift * UP, tuning.carry)
        yield from carry(self, hand, past + tuning.lift * UP, tuning.carry)
        laid = np.append(low[:2], max(low[2] + tuning.laid_height, chest_top(self) + tuning.off_chest))
        down = np.append(hand_now(self, hand)[:2, 3], laid[2])
        yield from carry(self, hand, down, tuning.carry, tuning.laying_speed)
        yield from carry(self, hand, laid + way, tuning.carry)
        yield from let_cloth_go(self, hand)
        yield from withdraw(self, [hand], tuning.withdrawal)

    def _places(self, middle: np.ndarray, aside: float, tries: Tries) -> list[GraspPoint]:
        """Where the cloth may be taken, best first: on its way to the midline if that is far.

        All are seen before a hand comes in between.
        """
        places = []
        for inward, footward in self.tuning.grasped:
            if inward <= abs(aside):
                with tries:
                    places.append(look_at_collar(self, middle, (-float(np.copysign(inward, aside)), footward)))
        return places

    def _take(self, hands: Sequence[Side], places: list[GraspPoint], tries: Tries) -> Generator[None, None, Side]:
        """Grasp the cloth at the first of the places that a hand gets to, and say which hand did."""
        for hand in hands:
            for place in places:
                with tries:
                    yield from take_from_above(self, hand, place, HEADWARD, self.tuning.grasp)
                    return hand
        raise tries.last

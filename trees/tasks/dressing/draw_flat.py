"""Draw the front of a worn gown flat, outwards and a little footward, from beside the bed."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, field

import numpy as np

from ....perception.errors import PerceptionFailure
from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_motion import while_person_rests
from ....skills.belief.shoulders import between_shoulders, look_at_collar
from ....skills.control.base import BaseTuning, stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import let_cloth_go
from ....skills.control.hands import hand_now
from ....skills.control.head import look_towards
from ....skills.control.take_from_above import FromAbove, take_from_above, within_reach
from ....skills.control.withdraw import withdraw
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.core.tries import Tries
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import HEADWARD, outwards
from ....skills.motion.errors import Unreachable


@dataclass(frozen=True, kw_only=True)
class DrawFlatTuning(Quantities):
    """Numbers of `DrawFlat`."""

    places: tuple[tuple[float, float], ...] = quantity(
        ((0.20, 0.80), (0.20, 0.65), (0.10, 0.65), (0.20, 0.50), (0.10, 0.50)),
        "m",
        "outwards of the midline and footward of the shoulders, where the hand takes the front: the first of them with "
        "cloth that it gets to",
        "measured with ideal hands, taken 0.65 and 0.90 m footward: no fold is left, the near sleeve comes to 0.31 "
        "and 0.37 (109); 0.90 m is the hem of a short gown; folds had taken the hem above 0.80 m (116, 195)",
    )
    way: tuple[float, float] = quantity(
        (0.20, 0.05),
        "m",
        "outwards and footward that the cloth is drawn",
        "measured, with both sleeves drawn up next, on two states before it: 0.81, 0.86 and 0.73, 0.71 up, the collar "
        "0.05 m aside at most, three layers on 2 % of the chest (188, 128); drawn 0.10 m outwards and 0.15 m footward "
        "0.92, 0.69 and 0.68, the right one off, the collar 0.10 m aside, 11 % (188)",
    )
    stand: BaseTuning = field(default_factory=lambda: BaseTuning(ease=(0.82, 0.22)))
    # twice as fast, the hand, which may come down beside the leg, met it with 113 N, not 88 N (147)
    grasp: FromAbove = field(default_factory=lambda: FromAbove(speed=0.1))
    attempts: int = quantity(
        2, "1", "at taking the cloth, each elsewhere", "choice: a hand that missed it once drew no fold out (135)"
    )
    lift: float = quantity(0.08, "m", "of the cloth before it is drawn", "choice: along the body it would slip back")
    laid_height: float = quantity(0.02, "m", "of the hand over where it took it", "choice: clear of the leg")
    laying_speed: float = quantity(0.05, "m/s", "of the hand on its way down", "choice: it may meet the leg")
    carry: Carry = field(default_factory=Carry)
    withdrawal: float = quantity(0.12, "m", "by which the open hand is drawn back", "choice: clear of the gown")


FLAT = DrawFlatTuning()
# Where the right arm is dressed last, the fold runs from its shoulder and lies higher.  Taken there, of 19 and 30 % of
# the chest under three layers 2 and 10 % are left (135, 193); drawn as usual from there 14 % of 19, and taken above the
# thigh, on either side, drawn as usual or by 0.10 and 0.15 m, 16 to 19 % of 19, 27 and 28 % of 30.
NEARER_THE_CHEST = DrawFlatTuning(
    places=((0.20, 0.50), (0.10, 0.50), (0.20, 0.60), (0.10, 0.60), (0.20, 0.65)), way=(0.25, 0.10)
)


class DrawFlat(Skill):
    """Takes the front above the thigh that is next to the robot, lifts it, and draws it outwards and a little footward.

    As the second sleeve comes up its arm, the front may fold from that shoulder to the other hip: three layers on a
    fifth of the chest, 3 cm high, which no camera of the robot tells from one layer.  So every front is drawn flat.
    Sleeves that come down by that are drawn up afterwards.
    """

    side = Input(Side, doc="of the bed, the person's own left or right, where the robot stands")
    hand = Input(Side, doc="hand of the robot, the one nearer to the feet")
    tuning = Input(DrawFlatTuning, default=FLAT, doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.PATH_BLOCKED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look, stand near, take, lift, draw, lay down, let go; cloth that was missed is taken at the next place."""
        self.note("looks at the front")
        out, places = outwards(self.side), self.tuning.places
        for left in reversed(range(self.tuning.attempts)):
            place, places = yield from self._place(out, places)
            try:
                yield from while_person_rests(self, self._draw(place, out))
                return
            except SkillFailure as failure:
                if failure.reason != Reason.GRASP_MISSED or not left or not places:
                    raise

    def _place(
        self, out: np.ndarray, places: tuple[tuple[float, float], ...]
    ) -> Generator[None, None, tuple[GraspPoint, tuple[tuple[float, float], ...]]]:
        """Where to take the front, and the places after it; the robot stands where its hand gets there.

        Raises:
            PerceptionFailure: no collar is seen, or no cloth at the last of the places.
            Unreachable: there is cloth at the last of them, where the hand does not get to.
        """
        tuning, middle, tries = self.tuning, between_shoulders(self), Tries(PerceptionFailure, Unreachable)
        for n, (outward, footward) in enumerate(places):
            aim = middle + outward * out - footward * HEADWARD
            yield from stand_for(self, self.hand, aim, tuning=tuning.stand)
            yield from look_towards(self, middle)
            with tries:
                away = aim - look_at_collar(self, middle).position_in_map
                place = look_at_collar(self, middle, (float(away[0]), float(away[1])))
                within_reach(self, self.hand, place, out, tuning.grasp)
                return place, places[n + 1 :]
        raise tries.last

    def _draw(self, place: GraspPoint, out: np.ndarray) -> Iterator[None]:
        tuning = self.tuning
        self.note("draws the front flat")
        yield from take_from_above(self, self.hand, place, out, tuning.grasp)
        start = hand_now(self, self.hand)[:3, 3]
        way = tuning.way[0] * out - tuning.way[1] * HEADWARD
        for shift in (tuning.lift * UP, tuning.lift * UP + way):
            yield from carry(self, self.hand, start + shift, tuning.carry)
        laid = np.append(hand_now(self, self.hand)[:2, 3], start[2] + tuning.laid_height)
        yield from carry(self, self.hand, laid, tuning.carry, tuning.laying_speed)
        yield from let_cloth_go(self, self.hand)
        yield from withdraw(self, [self.hand], tuning.withdrawal)

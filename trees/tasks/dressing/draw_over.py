"""Draw a worn gown that lies to one side over towards the midline."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ....perception.errors import PerceptionFailure
from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Side
from ....skills.belief.close_look import close_look
from ....skills.belief.person_motion import while_person_rests
from ....skills.belief.shoulders import between_shoulders, look_at_collar, off_middle
from ....skills.control.carry import Carry
from ....skills.control.fingers import let_cloth_go
from ....skills.control.hands import hand_now
from ....skills.control.head import look_towards
from ....skills.control.take_from_above import FromAbove, take_from_above
from ....skills.control.together import together
from ....skills.control.two_hands import carry_each, take_each
from ....skills.control.withdraw import withdraw
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.core.tries import Tries
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import HEADWARD, outwards


@dataclass(frozen=True, kw_only=True)
class DrawOverTuning(Quantities):
    """Numbers of `DrawOver`."""

    least: float = quantity(
        0.05, "m", "to one side, from which the gown is drawn over", "choice: as well as its collar is seen"
    )
    min_shown: float = quantity(
        0.7,
        "1",
        "share of the neckline that has to show to the head's camera",
        "measured: drawn over by a collar of which 0.39 showed, it went from 0.02 to 0.11 m aside (101); where 0.7 "
        "shows, its middle is missed by 0.09 m at most, where less shows by up to 0.18 m (68 views)",
    )
    min_shown_closely: float = quantity(
        0.4,
        "1",
        "likewise, looked at closely",
        "measured: all of 16 states that showed 0.44 to 0.70, seen 0.03 m aside or more, lay there (176 to 186); "
        "left as they lay, two were looked at 10 and 20 times more (195, 192)",
    )
    most: float = quantity(0.12, "m", "to draw it over at a time", "choice: with `beyond`, what was measured")
    beyond: float = quantity(
        0.05,
        "m",
        "by which it is carried farther than that",
        "measured: carried by 0.08 m it came over by 0.02 m (106), by 0.15 m by 0.10 m (103)",
    )
    apart: float = quantity(0.13, "m", "of either hand from the midline", "choice: the wrists do not meet")
    below_collar: float = quantity(
        0.15,
        "m",
        "of the hands from the collar",
        "measured with ideal hands, drawn over by 0.15 m: the collar came over by 0.17 m, taken 0.30 m below it "
        "by 0.11 m (103)",
    )
    footward: tuple[float, float] = quantity(
        (0.09, 0.14),
        "m",
        "of the hands from the shoulders, at least and at most",
        "measured: at 0.07 m one hand found no posture (0); 0.165 m is as far as they get from the head of the bed",
    )
    grasp: FromAbove = field(default_factory=lambda: FromAbove(speed=0.2))
    lift: float = quantity(0.10, "m", "of the cloth before it is carried", "choice: along the body it would slip back")
    laid_height: float = quantity(0.02, "m", "of the hands over where they took it", "choice: clear of the chest")
    laying_speed: float = quantity(0.03, "m/s", "of the hands on their way down", "choice: they may meet the chest")
    gap: float = quantity(
        0.04, "m", "between the robot's arms, at which they come no nearer", "choice: they only drift"
    )
    carry: Carry = field(default_factory=Carry)
    withdrawal: float = quantity(0.12, "m", "by which the open hands are drawn back", "choice: clear of the gown")


class DrawOver(Skill):
    """Looks whether the collar lies to one side, and draws the front over to the other.

    Dressing one arm after the other may leave the whole gown on the side of the first: its sleeve hangs low, and the
    collar lies aside and springs back.  Both hands take the front on the chest, lift it, carry it over and lay it down.
    That one sleeve is lower than the other tells nothing: a front that was drawn flat has lowered one
    (the collar went from 0.03 to 0.21 m aside by that, 109).  The robot stands at the head of the bed; the
    hands end open and drawn back.
    """

    tuning = Input(DrawOverTuning, default=DrawOverTuning(), doc="numbers of this skill")
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
        yield from while_person_rests(self, self._draw())

    def _draw(self) -> Iterator[None]:
        """Look, take, lift, carry, lay down, let go."""
        tuning = self.tuning
        self.note("looks whether the gown lies to one side")
        middle = between_shoulders(self)
        yield from look_towards(self, middle)
        collar = look_at_collar(self, middle)
        aside = off_middle(collar.position_in_map, middle)[0]
        self.note(f"the gown lies {abs(aside) * 100:.0f} cm to the {'right' if aside > 0.0 else 'left'}")
        min_shown = tuning.min_shown if close_look(self) is None else tuning.min_shown_closely
        if abs(aside) < tuning.least or collar.confidence < min_shown:
            return
        way = np.copysign(min(abs(aside), tuning.most) + tuning.beyond, aside) * outwards("left")
        places = self._places(middle, collar.position_in_map)
        held = yield from take_each({side: partial(self._take, side, place) for side, place in places.items()})
        start: dict[Side, np.ndarray] = {side: hand_now(self, side)[:3, 3] for side in held}
        for shift in (tuning.lift * UP, tuning.lift * UP + way):
            yield from carry_each(
                self, {side: place + shift for side, place in start.items()}, tuning.carry, tuning.gap
            )
        laid: dict[Side, np.ndarray] = {}
        for side, place in start.items():
            laid[side] = np.append(hand_now(self, side)[:2, 3], place[2] + tuning.laid_height)
        yield from carry_each(self, laid, tuning.carry, tuning.gap, tuning.laying_speed)
        yield from together(*(let_cloth_go(self, side) for side in held))
        yield from withdraw(self, held, tuning.withdrawal)

    def _places(self, middle: np.ndarray, collar: np.ndarray) -> dict[Side, GraspPoint]:
        """Where each hand takes the cloth on the chest; both are seen before a hand comes in between.

        A bare side of the chest is left out: the gown lay 0.09 m to the right, and was drawn up as it lay (189).

        Raises:
            PerceptionFailure: there is cloth on neither side.
        """
        tuning, bare = self.tuning, Tries(PerceptionFailure)
        footward = float(np.clip(tuning.below_collar - (collar - middle) @ HEADWARD, *tuning.footward))
        places: dict[Side, GraspPoint] = {}
        for side in SIDES:
            away = middle + tuning.apart * outwards(side) - footward * HEADWARD - collar
            with bare:
                places[side] = look_at_collar(self, middle, (float(away[0]), float(away[1])))
        if not places:
            raise bare.last
        return places

    def _take(self, side: Side, place: GraspPoint) -> Iterator[None]:
        yield from take_from_above(self, side, place, HEADWARD, self.tuning.grasp)

"""Take a laid gown up by a strap, from beside the bed: no arm is in it, and it shall be laid anew."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_tracking import PERSON_TRACKING, visible_share, watch_arm
from ....skills.belief.refused_stands import refused_stands
from ....skills.belief.short_gown import short_gown
from ....skills.belief.sleeve_search import find_sleeve, strap_position
from ....skills.control.base import stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.hands import cloth_load, hand_now
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP


class GoToStrap(Skill):
    """Sees that an arm is bare, and goes where a hand reaches the strap of its sleeve with ease.

    It fails where the arm is covered: its sleeve may be over the hand, and would lift it.
    """

    side = Input(Side, doc="the person's side")
    hand = Input(Side, doc="that will take the strap")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.ARM_COVERED,
        Reason.PATH_BLOCKED,
        Reason.COMMAND_LOST,
        Reason.TIMEOUT,
    )

    def steps(self) -> Iterator[None]:
        """Look once, then drive."""
        arm = watch_arm(self, self.side)
        share = visible_share(self.world.look("head"), arm)
        if share < PERSON_TRACKING.min_visible:
            raise SkillFailure(Reason.ARM_COVERED, f"{share:.0%} of the {self.side} arm show")
        strap = strap_position(find_sleeve(self, self.side, arm.points_in_map))
        yield from stand_for(self, self.hand, strap)


@dataclass(frozen=True, kw_only=True)
class TakeUpTuning(Quantities):
    """How a gown is taken up."""

    height: float = quantity(
        0.70,
        "m",
        "by which the hand rises",
        "measured: driven off with from 0.40 m up the gown pulled with 13 and 11 N, at 0.2 and 0.06 m/s, and 1 % of "
        "its edges were 59 and 49 % longer (25 allowed); from 0.55 m with 5.6 N, 25 %; from 0.70 m with 6.1 N, 19 % "
        "(103)",
    )
    least: float = quantity(0.58, "m", "that will do", "choice: between what was measured")
    speed: float = quantity(0.10, "m/s", "of the hand", "choice: what lies on legs comes along slowly")
    max_load: float = quantity(
        8.0,
        "N",
        "of the gown, at which it is let be",
        "choice: twice the 4 N that it weighs, as it rubs on the bed",
    )


class TakeUpGown(Skill):
    """Raises the hand that holds a strap, no harder than the gown weighs and rubs on the bed.

    What was known of where its sleeve lies is forgotten.  It fails where the gown holds the hand back: something is in
    it, or on it.
    """

    side = Input(Side, doc="the person's side, whose sleeve is held by its strap")
    hand = Input(Side, doc="that holds it")
    tuning = Input(TakeUpTuning, default=TakeUpTuning(), doc="numbers of this skill")
    reasons = (Reason.SLEEVE_CAUGHT, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Straight up."""
        self.note("takes the gown up")
        refused_stands(self, self.side).clear()
        short_gown(self).discard(self.side)
        start = hand_now(self, self.hand)[:3, 3]
        law = Carry(speed=self.tuning.speed, max_load=self.tuning.max_load)
        yield from carry(self, self.hand, start + self.tuning.height * UP, law)
        risen = float(hand_now(self, self.hand)[2, 3] - start[2])
        load = float(np.linalg.norm(cloth_load(self, self.hand)))
        if risen < self.tuning.least:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, f"{risen:.2f} m up the gown pulls with {load:.1f} N")
        self.note(f"carries {load:.1f} N")

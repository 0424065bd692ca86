"""Stages C and D: whether the arm is inside its sleeve, and how far up, now that nothing stands before it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.world import Side
from .belief.person_tracking import watch_arm
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill

# The cuff of a sleeve with the arm inside shows at least so far down the upper arm: 0.29 to 0.77 of it in recorded
# runs, 0.01 and 0.05 where the sleeve had missed the arm and lay in a heap at the shoulder.
CUFF_AT = 0.15
# It shows at least so far round the arm: 0.58 to 0.92 in recorded runs, 0.17 and 0.33 where the sleeve lay beside it.
# Two arms inside showed 0.33: one whose posture was out of date (31), and one on seed 3, not looked into.
ROUND = 0.4


class CheckSleeve(Skill):
    """Looks where the cuff is: down the arm and round it, in a heap at the shoulder, or beside the arm.

    A sleeve of which too little shows is let pass.

    Inputs: `side` of the person; `upto`, how far from the shoulder the cuff of a sleeve that sits well shows at
    most, along the upper arm [m].
    """

    commands = False
    side = Input(Side)
    upto = Input(float, default=np.inf)
    reasons = (Reason.SLEEVE_MISSED, Reason.SLEEVE_LOW, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        arm = watch_arm(self, self.side).points_in_map
        try:
            seen = self.context.senses.worn_sleeve(self.world.look("head"), side=self.side, arm_in_map=arm)
        except PerceptionFailure:
            self.note(f"cannot see the {self.side} sleeve's bindings")
            return
        self.note(
            f"{self.side} armhole at {seen.armhole_at:.2f} of the upper arm, cuff at {seen.cuff_at:.2f}, "
            f"{seen.round_arm:.0%} round it"
        )
        if seen.cuff_at < CUFF_AT or seen.round_arm < ROUND:
            raise SkillFailure(
                Reason.SLEEVE_MISSED,
                f"the cuff is at {seen.cuff_at:.2f} of the upper arm and shows "
                f"{seen.round_arm:.0%} of the way round it",
            )
        away = seen.cuff_at * float(np.linalg.norm(arm[1] - arm[0]))
        if away > self.upto:
            raise SkillFailure(
                Reason.SLEEVE_LOW,
                f"the cuff is {away * 100:.0f} cm down the arm, {self.upto * 100:.0f} cm at most are asked for",
            )
        yield

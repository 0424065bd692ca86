"""Stages C and D: whether the arm is inside its sleeve, and how far up, now that nothing stands before it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import Cover, WornSleeve
from ..sim.world import Side
from .context import Context
from .ports import Input
from .reasons import Reason, SkillFailure
from .scripted_person import offer_person
from .skill import Skill
from .tracking import watch_arm

# The cuff of a sleeve with the arm inside shows at least so far down the upper arm.  In recorded runs on seeds 0-8 it
# showed at 0.40 to 0.66 where the arm was inside, at 0.01, 0.05 and 0.31 where the sleeve had missed it.
CUFF_AT = 0.34
# A sleeve drawn up a spread arm shows its cuff at 0.29 when it is over the shoulder.  There the arm is hidden from the
# shoulder down to the cuff; beside a sleeve that missed it, it shows.  From one sleeve on its arm and one beside it,
# both with the cuff at 0.29; no run since has come to it, so that how well it tells them apart is not measured.
OVER_SHOULDER, HIDDEN = 0.15, 0.7


class CheckSleeve(Skill):
    """Looks where the cuff is: down the arm that came through it, or in a heap at the shoulder.

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
            seen = self.context.perceive("worn_sleeve", self.world.look("head"), side=self.side, arm_in_map=arm)
        except PerceptionFailure:
            self.note(f"cannot see the {self.side} sleeve's bindings")
            return
        assert isinstance(seen, WornSleeve)
        self.note(f"{self.side} armhole at {seen.armhole_at:.2f} of the upper arm, cuff at {seen.cuff_at:.2f}")
        if seen.cuff_at < CUFF_AT and not self._hidden(arm, seen.cuff_at):
            raise SkillFailure(Reason.SLEEVE_MISSED, f"the cuff is at {seen.cuff_at:.2f} of the upper arm")
        away = seen.cuff_at * float(np.linalg.norm(arm[1] - arm[0]))
        if away > self.upto:
            raise SkillFailure(Reason.SLEEVE_LOW, f"the cuff is {away * 100:.0f} cm down the arm, "
                                                  f"{self.upto * 100:.0f} cm at most are asked for")
        yield

    def _hidden(self, arm: np.ndarray, cuff_at: float) -> bool:
        """Whether something covers the arm (4, 3) from the shoulder down to the cuff."""
        if cuff_at < OVER_SHOULDER:
            return False
        axis = arm[0] + np.outer(np.linspace(0.05, cuff_at - 0.05, 8), arm[1] - arm[0])
        try:
            cover = self.context.perceive("hand_cover", self.world.look("head"), points_in_map=axis)
        except PerceptionFailure:
            return False
        assert isinstance(cover, Cover)
        self.note(f"{cover.share:.0%} of the {self.side} arm above the cuff are hidden")
        return cover.share > HIDDEN

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_person(context)
        return cls("check sleeve", context, side="right")

"""Stage C: whether the arm is inside its sleeve, now that nothing stands before it."""

from __future__ import annotations

from collections.abc import Iterator

from ..perception.errors import PerceptionFailure
from ..perception.estimates import WornSleeve
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


class CheckSleeve(Skill):
    """Looks where the cuff is: down the arm that came through it, or in a heap at the shoulder.

    A sleeve of which too little shows is let pass.

    Inputs: `side` of the person.
    """

    commands = False
    side = Input(Side)
    reasons = (Reason.SLEEVE_MISSED, Reason.ARM_LOST)

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
        if seen.cuff_at < CUFF_AT:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"the cuff is at {seen.cuff_at:.2f} of the upper arm")
        yield

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_person(context)
        return cls("check sleeve", context, side="right")

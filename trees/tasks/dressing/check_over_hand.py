"""Look whether an arm that is not dressed yet has its hand inside the sleeve already."""

from __future__ import annotations

from collections.abc import Iterator

from ....perception.errors import PerceptionFailure
from ....sim.world import Side
from ....skills.belief.over_hand import OverHandTuning, on_forearm
from ....skills.belief.person_tracking import watch_arm
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill


class CheckOverHand(Skill):
    """Looks whether the sleeve is on its arm, past the wrist; it fails where it lies elsewhere, or does not show.

    A hand comes to be inside unasked, where an arm is lifted under its sleeve and put down again (0), and stays inside
    where what follows goes wrong.  Such a sleeve is drawn on from where it is: laid out anew, it would be taken off.
    """

    commands = False
    side = Input(Side, doc="the person's side")
    tuning = Input(OverHandTuning, default=OverHandTuning(), doc="numbers of this skill")
    reasons = (Reason.SLEEVE_MISSED, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        arm = watch_arm(self, self.side).points_in_map
        frame, senses = self.world.look("head"), self.context.senses
        try:
            seen = on_forearm(senses, frame, self.side, arm, self.tuning.points)
        except PerceptionFailure as hidden:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"{hidden}") from None
        if not seen.over_hand(self.tuning):
            raise SkillFailure(
                Reason.SLEEVE_MISSED,
                f"armhole at {seen.armhole_at:.2f} of the forearm, cuff at {seen.cuff_at:.2f}, "
                f"{seen.round_arm:.0%} round it, {seen.covered:.0%} covered",
            )
        self.note(f"the {self.side} sleeve is over the hand, its armhole at {seen.armhole_at:.2f} of the forearm")
        yield

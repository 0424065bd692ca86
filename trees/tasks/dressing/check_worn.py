"""Ask of what was seen closely whether a sleeve sits on an arm that lies: nobody need go and see it from beside."""

from __future__ import annotations

from collections.abc import Iterator

from ....sim.world import Side
from ....skills.belief.close_look import sleeve_seen
from ....skills.belief.person_tracking import watch_arm
from ....skills.check_sleeve import CheckSleeveTuning
from ....skills.control.lowering import lies
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.lower_arm import LowerArmTuning


class CheckWorn(Skill):
    """Fails where a sleeve was not looked at closely since the gown was touched, or that does not tell it surely.

    It is told by its armhole, by its cuff, which shows round the arm but for less than half of the way, and by the
    arm, which lies as far as it is known.
    """

    commands = False
    side = Input(Side, doc="arm of the person")
    min_reach = Input(float, unit="1", doc="how far up the upper arm the armhole is at least: 0 elbow, 1 shoulder")
    tuning = Input(CheckSleeveTuning, default=CheckSleeveTuning(), doc="what tells that an arm is inside")
    lowering = Input(LowerArmTuning, default=LowerArmTuning(), doc="numbers of `LowerArm`, which tell that an arm lies")
    reasons = (Reason.NOTHING_SEEN, Reason.SLEEVE_LOW, Reason.ARM_SLIPPED, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """Nothing moves, and no camera is asked but for the arm."""
        seen = sleeve_seen(self, self.side)
        if seen is None:
            raise SkillFailure(Reason.NOTHING_SEEN, f"the {self.side} sleeve was not looked at closely")
        if seen.reach < self.min_reach:
            raise SkillFailure(Reason.SLEEVE_LOW, f"{seen.reach:.2f}, at least {self.min_reach:.2f} is asked for")
        if seen.round_arm <= self.tuning.min_round_closely:
            raise SkillFailure(Reason.NOTHING_SEEN, f"its cuff shows {seen.round_arm:.0%} of the way round the arm")
        if not lies(self, watch_arm(self, self.side), self.lowering.lies_below):
            raise SkillFailure(Reason.ARM_SLIPPED, f"the {self.side} arm does not lie")
        self.note(f"the {self.side} arm lies inside its sleeve")
        yield

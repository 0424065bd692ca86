"""Let a held arm go: lower it first until it lies or leave it where the gown carries it, open, and draw away."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ..sim.quantity import Quantities
from ..sim.world import Side
from .control.arm_grip import holds_arm
from .control.let_arm_go import LetArmGoTuning, let_arm_go
from .control.lowering import LoweringTuning, held_arm, lower_arm
from .control.ready import Ready
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class ReleaseArmTuning(Quantities):
    """How an arm is lowered, and how the hand leaves it."""

    lowering: LoweringTuning = field(default_factory=LoweringTuning)
    leaving: LetArmGoTuning = field(default_factory=LetArmGoTuning)


class ReleaseArm(Skill):
    """Ends a hold of the person's arm, whatever state it is in; a hand that holds nothing just opens and withdraws.

    An arm that is to be lowered is swung down until it lies.  Where it does not come down, the skill fails and the
    hand still holds it: release it without lowering then.  It also fails where a command is lost, or where no way to
    the ready posture is found.
    """

    hand = Input(Side, doc="hand of the robot that holds the arm")
    lower = Input(bool, default=False, doc="whether the arm is lowered onto the bed first")
    ready = Input(Ready, default="never", doc="whether the hand then goes to its ready posture")
    tuning = Input(ReleaseArmTuning, default=ReleaseArmTuning(), doc="numbers of this skill")
    reasons = (Reason.MOTION_BLOCKED, Reason.TIMEOUT, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Lower if asked to, open, up and away."""
        if self.lower and holds_arm(self, self.hand):
            held = held_arm(self, self.hand, tuning=self.tuning.lowering)
            self.note(f"lowers the {held[0]} arm" if held else "lowers the arm")
            yield from lower_arm(self, self.hand, held, tuning=self.tuning.lowering)
        yield from let_arm_go(self, self.hand, self.ready, tuning=self.tuning.leaving)

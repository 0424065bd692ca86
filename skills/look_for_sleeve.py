"""Look for a sleeve while nothing stands before it yet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..perception.errors import PerceptionFailure
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_tracking import careful
from .belief.sleeve_search import SLEEVE_SEARCH, look_for_sleeve
from .control.hands import hand_now, move_hands
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LookForSleeveTuning(Quantities):
    """Numbers of the look from above."""

    return_speed: float = quantity(
        0.5, "m/s", "of the hand on its way back, away from the person", "choice: quick in the open"
    )


class LookForSleeve(Skill):
    """Looks until the sleeve shows well, from the head and with the hand's camera, so that it is known after the lift.

    A sleeve that shows badly from everywhere, or an arm that is lost meanwhile, is no failure: who lifts the arm looks
    again.  It fails where a hand does not move.
    """

    side = Input(Side, doc="arm of the person that the sleeve belongs to")
    hand = Input(Side, doc="hand whose camera may look from above")
    tuning = Input(LookForSleeveTuning, default=LookForSleeveTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Look; then the hand goes back to where it was."""
        self.note(f"looks for the {self.side} sleeve")
        start = hand_now(self, self.hand)
        try:
            seen = yield from look_for_sleeve(self, self.side, self.hand)
        except PerceptionFailure as hidden:
            self.note(f"does not see the {self.side} sleeve: {hidden}")
        else:
            shows = "shows well" if seen.confidence > SLEEVE_SEARCH.clear_confidence else "shows badly"
            self.note(f"the {self.side} sleeve {shows}, {seen.confidence:.2f}")
        try:
            speed = careful(self, self.tuning.return_speed)
            yield from move_hands(self, {self.hand: start}, way="any", speed=speed)
        except MotionError:
            return  # the next motion begins from here

"""Look whether the middle of the collar lies in the middle between the shoulders."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ....perception.errors import PerceptionFailure
from ....sim.quantity import Quantities, quantity
from ....skills.belief.shoulders import between_shoulders, look_at_collar, off_middle
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class CheckCollarTuning(Quantities):
    """Where the collar of a gown that is worn neatly lies."""

    min_shown: float = quantity(
        0.0,
        "1",
        "share of the neckline that has to show",
        "choice: any tells that it is off the throat",
    )
    max_aside: float = quantity(0.07, "m", "of its middle from the midline", "design requirement: as a nurse leaves it")
    max_headward: float = quantity(
        0.10, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )
    max_footward: float = quantity(
        0.08, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )


class CheckCollar(Skill):
    """Fails where the collar's middle is seen off its place, and where it is not seen."""

    commands = False
    tuning = Input(CheckCollarTuning, default=CheckCollarTuning(), doc="numbers of this skill")
    reasons = (Reason.COLLAR_ASIDE, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        middle = between_shoulders(self)
        try:
            seen = look_at_collar(self, middle)
        except PerceptionFailure as hidden:
            raise SkillFailure(Reason.NOTHING_SEEN, f"{hidden}") from None
        if seen.confidence < self.tuning.min_shown:
            raise SkillFailure(Reason.NOTHING_SEEN, f"{seen.confidence * 100:.0f} % of the neckline shows, too little")
        aside, ahead = off_middle(seen.position_in_map, middle)
        where = f"{aside * 100:.0f} cm aside, {ahead * 100:.0f} cm headward of the shoulders"
        self.note(f"the collar's middle is {where}")
        if abs(aside) > self.tuning.max_aside or not -self.tuning.max_footward <= ahead <= self.tuning.max_headward:
            raise SkillFailure(Reason.COLLAR_ASIDE, where)
        yield

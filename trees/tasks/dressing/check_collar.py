"""Look whether the middle of the collar lies in the middle between the shoulders."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ....sim.quantity import Quantities, quantity
from ....skills.belief.close_look import close_look
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
    min_told: float = quantity(
        0.0, "1", "share of it, looked at closely, from which that tells its middle", "choice: any does"
    )
    min_told_from_head: float = quantity(
        0.0, "1", "share of it that tells its middle to the head's camera", "choice: any does"
    )
    surely_aside: float = quantity(
        0.03,
        "m",
        "of its middle from the midline, as both hands see it, from which it lies on that side however little tells",
        "measured: all of 16 states of seeds 176 to 186 of which 0.44 to 0.70 told, lay on that side, 15 of them more "
        "than they were seen",
    )
    max_aside: float = quantity(0.07, "m", "of its middle from the midline", "design requirement: as a nurse leaves it")
    max_headward: float = quantity(
        0.10, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )
    max_footward: float = quantity(
        0.08, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )


class CheckCollar(Skill):
    """Fails where the collar's middle is seen off its place, where too little of it shows to tell, and unseen.

    A close look counts where there was one since it was touched (`LookAtCollar`), else one with the head's camera.
    """

    commands = False
    tuning = Input(CheckCollarTuning, default=CheckCollarTuning(), doc="numbers of this skill")
    reasons = (Reason.COLLAR_ASIDE, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        tuning, middle = self.tuning, between_shoulders(self)
        closely = close_look(self) is not None
        seen = look_at_collar(self, middle)
        shows = f"{seen.confidence * 100:.0f} % of the neckline shows"
        aside, ahead = off_middle(seen.position_in_map, middle)
        surely_aside = closely and abs(aside) > tuning.surely_aside
        if seen.confidence < tuning.min_shown and not surely_aside:
            raise SkillFailure(Reason.NOTHING_SEEN, f"{shows}, too little")
        if seen.confidence < (tuning.min_told if closely else tuning.min_told_from_head):
            raise SkillFailure(Reason.COLLAR_ASIDE, f"{shows}, too little to tell its middle")
        place = f"{aside * 100:.0f} cm aside, {ahead * 100:.0f} cm headward of the shoulders"
        self.note(f"the collar's middle is {place}")
        if abs(aside) > tuning.max_aside or not -tuning.max_footward <= ahead <= tuning.max_headward:
            raise SkillFailure(Reason.COLLAR_ASIDE, place)
        yield

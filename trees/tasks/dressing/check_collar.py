"""Look whether the middle of the collar lies in the middle between the shoulders."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....perception.errors import PerceptionFailure
from ....sim.quantity import Quantities, quantity
from ....skills.belief.shoulders import between_shoulders, look_at_collar, off_middle
from ....skills.core.ports import Input, Output
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
    min_looks: int = quantity(1, "1", "that showed so much of it", "choice: one, of what is looked at once")
    max_aside: float = quantity(0.07, "m", "of its middle from the midline", "design requirement: as a nurse leaves it")
    max_headward: float = quantity(
        0.10, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )
    max_footward: float = quantity(
        0.08, "m", "of its middle from the line of the shoulders", "design requirement: as a nurse leaves it"
    )


class CheckCollar(Skill):
    """Fails where the collar's middle is seen off its place, and where it is not seen.

    Seen from several places, it is aside by as much as on average; a look that does not `decide` only adds to them.
    """

    commands = False
    before = Input(tuple, default=(), unit="m", doc="how far aside it was seen from elsewhere just before")
    decide = Input(bool, default=True, doc="whether it may fail; else it only looks")
    looks = Output(tuple, unit="m", doc="those before, and how far aside it is seen now, where enough shows")
    tuning = Input(CheckCollarTuning, default=CheckCollarTuning(), doc="numbers of this skill")
    reasons = (Reason.COLLAR_ASIDE, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        middle = between_shoulders(self)
        looks, ahead = self.before, 0.0
        try:
            seen = look_at_collar(self, middle)
        except PerceptionFailure as none:
            hidden = f"{none}"
        else:
            hidden = f"{seen.confidence * 100:.0f} % of the neckline shows, too little"
            if seen.confidence >= self.tuning.min_shown:
                aside, ahead = off_middle(seen.position_in_map, middle)
                looks = (*looks, aside)
                self.note(f"the collar's middle is {_place(aside, ahead)}")
        self.looks = looks
        if self.decide:
            self._judge(looks, ahead, hidden)
        yield

    def _judge(self, looks: tuple[float, ...], ahead: float, hidden: str) -> None:
        """Whether it lies where it should by all `looks` [m], and `ahead` by the last one [m].

        Raises:
            SkillFailure: COLLAR_ASIDE, and NOTHING_SEEN where it is `hidden` too often.
        """
        tuning = self.tuning
        if len(looks) < tuning.min_looks:
            raise SkillFailure(Reason.NOTHING_SEEN, hidden)
        aside = float(np.mean(looks))
        if abs(aside) > tuning.max_aside or not -tuning.max_footward <= ahead <= tuning.max_headward:
            told = "" if len(looks) == 1 else f", the mean of {len(looks)} looks"
            raise SkillFailure(Reason.COLLAR_ASIDE, _place(aside, ahead) + told)


def _place(aside: float, ahead: float) -> str:
    return f"{aside * 100:.0f} cm aside, {ahead * 100:.0f} cm headward of the shoulders"

"""Look whether the person's face is free of the gown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....perception.errors import PerceptionFailure
from ....sim.quantity import Quantities, quantity
from ....skills.belief.shoulders import between_shoulders
from ....skills.control.head import look_towards
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.geometry.stances import HEADWARD


@dataclass(frozen=True, kw_only=True)
class CheckFaceTuning(Quantities):
    """Where mouth and nose are, and how much of them has to show."""

    headward: tuple[float, float] = quantity(
        (0.13, 0.19),
        "m",
        "of mouth and nose from the line of the shoulders",
        "paper: Winter, fig. 4.1: the crown is 0.31 m from the shoulders, a head 0.23 m long; the nose ends 0.14 to "
        "0.16 m from the crown, the mouth 0.02 m farther",
    )
    height: float = quantity(0.19, "m", "of the face above the mattress", "choice: as high as a lying head is seen")
    half_width: float = quantity(0.02, "m", "of what is looked at, from the midline", "choice: a mouth's")
    points: int = quantity(5, "1", "looked at along and across", "choice: a few pixels apart")
    max_covered: float = quantity(
        0.4, "1", "share of them that may not show skin", "choice: eyes, lips and hair are no skin either"
    )


class CheckFace(Skill):
    """Fails where cloth lies over mouth and nose, or where they are out of the picture.

    It looks from the head of the bed, once the hands are drawn back.
    """

    tuning = Input(CheckFaceTuning, default=CheckFaceTuning(), doc="numbers of this skill")
    reasons = (Reason.FACE_COVERED, Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Turn the head there, and one look."""
        tuning = self.tuning
        middle = between_shoulders(self)
        along = np.linspace(*tuning.headward, tuning.points)
        across = np.linspace(-tuning.half_width, tuning.half_width, tuning.points)
        ahead, aside = (values.ravel() for values in np.meshgrid(along, across))
        face = middle + ahead[:, None] * HEADWARD + aside[:, None] * (1.0, 0.0, 0.0)
        face[:, 2] = self.world.room.bed[1, 2] + tuning.height
        yield from look_towards(self, face.mean(axis=0))
        try:
            seen = self.context.senses.skin_cover(self.world.look("head"), points_in_map=face)
        except PerceptionFailure as hidden:  # a face that is not seen is not known to be free
            raise SkillFailure(Reason.NOTHING_SEEN, f"{hidden}") from None
        self.note(f"{1.0 - seen.share:.0%} of mouth and nose show")
        if seen.share > tuning.max_covered:
            raise SkillFailure(Reason.FACE_COVERED, f"{1.0 - seen.share:.0%} of mouth and nose show")

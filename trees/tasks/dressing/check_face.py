"""Look whether the person's face is free of the gown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ....perception.errors import PerceptionFailure
from ....sim.quantity import Quantities, quantity
from ....skills.belief.face import FACE, cover_of, face_points
from ....skills.belief.shoulders import between_shoulders
from ....skills.control.head import look_towards
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class CheckFaceTuning(Quantities):
    """How much of mouth and nose has to show."""

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
        face = face_points(self, between_shoulders(self), FACE.mouth_and_nose)
        yield from look_towards(self, face.mean(axis=0))
        try:
            seen = cover_of(self, face)
        except PerceptionFailure as hidden:  # a face that is not seen is not known to be free
            raise SkillFailure(Reason.NOTHING_SEEN, f"{hidden}") from None
        self.note(f"{1.0 - seen.share:.0%} of mouth and nose show")
        if seen.share > self.tuning.max_covered:
            raise SkillFailure(Reason.FACE_COVERED, f"{1.0 - seen.share:.0%} of mouth and nose show")

"""Check which side of the gown faces the robot."""

from __future__ import annotations

from collections.abc import Iterator

from ..perception.estimates import GownSide
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


class FlipSideCheck(Skill):
    """Looks at the gown between the hands, or on its hook, and fails unless its printed outside faces the robot."""

    commands = False
    hung = Input(bool, doc="whether the gown is on its hook, and not between the hands", default=False)
    count = Input(int, unit="1", doc="number of frames that vote", default=3)
    min_confidence = Input(
        float,
        unit="1",
        doc="confidence above which a view of the inside counts; sleeves and folds always show some of it",
        default=0.6,
    )
    seen = Output(GownSide, doc="the last estimate")
    reasons = (Reason.WRONG_SIDE, Reason.NOTHING_SEEN, Reason.SENSOR_LOST)

    def steps(self) -> Iterator[None]:
        """Look a few times and take the majority."""
        votes, side = 0, None
        for _ in range(self.count):
            senses, frame = self.context.senses, self.world.look("head")
            side = senses.hung_side(frame) if self.hung else senses.gown_side(frame)
            votes += -1 if not side.outside and side.confidence > self.min_confidence else 1
            yield
        if side is not None:
            self.seen = side
        if votes < 0:
            raise SkillFailure(Reason.WRONG_SIDE, "the inside faces the robot")

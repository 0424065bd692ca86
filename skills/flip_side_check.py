"""Stage B: which side of the gown faces the robot before it is laid down."""

from __future__ import annotations

from collections.abc import Iterator

from ..perception.estimates import GownSide
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill, SkillFailure


class FlipSideCheck(Skill):
    """Looks at the gown between the hands, or on its hook; the printed outside must face the robot.

    Inputs: `hung`, whether it is on its hook; `looks`, how many frames vote; `sure`, the confidence from which a sight
    of the inside counts (sleeves and folds always show some of it).  Outputs: `seen`, the last estimate.
    """

    commands = False
    hung = Input(bool, default=False)
    looks = Input(int, default=3)
    sure = Input(float, default=0.6)
    seen = Output(GownSide)
    reasons = (Reason.WRONG_SIDE, Reason.NOTHING_SEEN, Reason.SENSOR_LOST)

    def steps(self) -> Iterator[None]:
        """Look a few times and take the majority."""
        votes, side = 0, None
        for _ in range(self.looks):
            senses, frame = self.context.senses, self.world.look("head")
            side = senses.hung_side(frame) if self.hung else senses.gown_side(frame)
            votes += -1 if not side.outside and side.confidence > self.sure else 1
            yield
        if side is not None:
            self.seen = side
        if votes < 0:
            raise SkillFailure(Reason.WRONG_SIDE, "the inside faces the robot")

"""Let go with one hand and draw it back."""

from __future__ import annotations

from collections.abc import Iterator

from ..sim.world import Side
from .control.hands import open_gripper
from .control.pinch import back_off
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .motion.errors import MotionError


class Release(Skill):
    """Opens the fingers of one hand, then draws it back along its own approach as far as the arm can.

    Inputs: `side`, the hand; `distance` to draw it back at most [m].
    """

    side = Input(Side)
    distance = Input(float, default=0.15)
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Open, draw back."""
        self.note(f"the {self.side} hand lets go")
        yield from open_gripper(self, self.side)
        for share in (1.0, 0.5, 0.25):
            try:
                yield from back_off(self, self.side, share * self.distance)
                return
            except MotionError:  # too far for this arm: less will do
                continue

"""Let go with one hand and draw it back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .control.fingers import open_gripper
from .control.pinch import back_off
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class ReleaseTuning(Quantities):
    """Numbers of `Release`."""

    distance_shares: tuple[float, ...] = quantity(
        (1.0, 0.5, 0.25), "1", "shares of `distance` that are tried in turn", "choice: less is better than nothing"
    )


class Release(Skill):
    """Opens the fingers of one hand, then draws it back along its own approach as far as the arm can."""

    hand = Input(Side, doc="the hand that lets go")
    distance = Input(float, unit="m", doc="by which the hand is drawn back at most", default=0.15)
    tuning = Input(ReleaseTuning, default=ReleaseTuning(), doc="numbers of this skill")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Open, draw back."""
        self.note(f"the {self.hand} hand lets go")
        yield from open_gripper(self, self.hand)
        for share in self.tuning.distance_shares:
            with suppress(MotionError):  # too far for this arm: less will do
                yield from back_off(self, self.hand, share * self.distance)
                return

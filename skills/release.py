"""Let go with one hand or both, and draw them back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Hands, Side
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
    """Opens the fingers of a hand or both, then draws each back along its own approach as far as the arm can."""

    hand = Input(Hands, doc="the hand that lets go", default="both")
    distance = Input(float, unit="m", doc="by which the hand is drawn back at most", default=0.15)
    tuning = Input(ReleaseTuning, default=ReleaseTuning(), doc="numbers of this skill")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Open, draw back."""
        self.note("both hands let go" if self.hand == "both" else f"the {self.hand} hand lets go")
        sides: list[Side] = [side for side in SIDES if self.hand in (side, "both")]
        for side in sides:
            yield from open_gripper(self, side)
        if self.distance > 0.0:
            for side in sides:
                yield from self._draw_back(side)

    def _draw_back(self, side: Side) -> Iterator[None]:
        for share in self.tuning.distance_shares:
            with suppress(MotionError):  # too far for this arm: less will do
                yield from back_off(self, side, share * self.distance)
                return

"""Let go of a gown whose neckline is down on the person, and draw both hands and the base back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Side
from ....skills.control.base import drive_to
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import hand_now, move_hands
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.geometry.stances import STANCES


@dataclass(frozen=True, kw_only=True)
class LetGownGoTuning(Quantities):
    """How the hands and the base leave the gown."""

    withdrawal: tuple[float, float, float] = quantity(
        (0.0, 0.06, 0.22), "m", "of the open hands in the map", "choice: up and off the cloth, towards the feet"
    )
    withdrawal_speed: float = quantity(0.3, "m/s", "of the open hands", "choice: they hold nothing")
    final_y: float = quantity(1.6, "m", "of the base in the end", "choice: the arms are clear of the bed")


class LetGownGo(Skill):
    """Opens the near hand first: then its back panel swings out over the edge of the bed; up, and back."""

    tuning = Input(LetGownGoTuning, default=LetGownGoTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.PATH_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Open, rise, drive back."""
        tuning = self.tuning
        self.note("lets the gown go")
        for side in SIDES:
            yield from open_gripper(self, side)
        self.note("withdraws")
        up: dict[Side, np.ndarray] = {side: hand_now(self, side) for side in SIDES}
        for pose in up.values():
            pose[:3, 3] += tuning.withdrawal
        yield from move_hands(self, up, speed=tuning.withdrawal_speed, free="any", retreat=True)
        away = np.array((STANCES.lane, tuning.final_y, STANCES.heading))
        yield from drive_to(self, away, straight=True, retreat=True)

"""Wait until the cameras show something again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..sim.quantity import Quantities, quantity
from ..sim.world import SensorLost
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class WaitForSightTuning(Quantities):
    """Numbers of the wait."""

    patience: float = quantity(
        30.0, "s", "for all cameras to show again", "design requirement: a camera that is dead for 20 s ends no run"
    )


class WaitForSight(Skill):
    """Moves nothing until every camera gives a new image in the same tick; gives up after a while."""

    commands = False
    tuning = Input(WaitForSightTuning, default=WaitForSightTuning(), doc="numbers of this skill")
    reasons = (Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Look with each camera once per tick."""
        end = self.now() + self.tuning.patience
        while True:
            try:
                for camera in self.world.robot.cameras:
                    self.world.look(camera)
            except SensorLost as lost:
                if self.now() >= end:
                    raise
                self.note(f"waits: {lost}")
            else:
                return
            yield

"""Stand still and watch for a while."""

from __future__ import annotations

from collections.abc import Iterator

from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill


class HoldStill(Skill):
    """Stands still and looks once per tick; gives up when the camera does."""

    commands = False
    seconds = Input(float, unit="s", doc="how long", default=1.0)
    reasons = (Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Look once per tick."""
        end = self.now() + self.seconds
        while self.now() < end:
            self.world.look("head")
            yield

"""Stand still and watch for a while, or until there is something to watch."""

from __future__ import annotations

from collections.abc import Iterator

from ..sim.world import SensorLost
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill


class HoldStill(Skill):
    """Stands still and looks once per tick; gives up when a camera does, and has not come back within its patience."""

    commands = False
    seconds = Input(float, unit="s", doc="how long", default=1.0)
    all_cameras = Input(bool, doc="whether it looks with those of the hands too", default=False)
    patience = Input(float, unit="s", doc="for which it waits for images", default=0.0)
    reasons = (Reason.SENSOR_LOST, Reason.SENSOR_STALE)

    def steps(self) -> Iterator[None]:
        """Look once per tick, and go on as long as nothing is seen."""
        begun = seen_last = self.now()
        seen, cameras = self.patience <= 0.0, self.world.robot.cameras if self.all_cameras else ("head",)
        while not seen or self.now() < begun + self.seconds:
            try:
                for camera in cameras:
                    self.world.look(camera)
            except SensorLost as lost:
                if self.now() >= seen_last + self.patience:
                    raise
                self.note(f"waits: {lost}")
                seen = False
            else:
                seen, seen_last = True, self.now()
                if seen_last >= begun + self.seconds:
                    return
            yield

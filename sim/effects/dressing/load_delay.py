"""Wrists' force sensors that tell late what pulls on the hands."""

from __future__ import annotations

from dataclasses import replace

from ...sensors.sensor_changes import SensorChanges
from ..effect import Parameter
from .dressing_effect import DressingEffect


class LoadDelay(DressingEffect):
    """Time by which both sensors are behind the joints, as one that is filtered is."""

    name = "load_delay"
    targets = ("wrists",)
    parameters = (Parameter(name="delay", unit="s", lower=0.0, upper=1.0, typical=0.2),)

    def sensors(self, sensors: SensorChanges, target: str, values: dict[str, float]) -> SensorChanges:
        """See `DressingEffect.sensors`."""
        return replace(sensors, delay=sensors.delay + values["delay"])

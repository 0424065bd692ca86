"""The head's camera does not sit where the robot takes it to be."""

from __future__ import annotations

from dataclasses import replace

from ...sensors.sensor_changes import SensorChanges
from ..effect import Parameter
from .dressing_effect import DressingEffect

MOST = 0.1  # [m]


class CameraOffset(DressingEffect):
    """Where it sits, along its own axes from where it is taken to be: x right, y down, z forward."""

    name = "camera_offset"
    targets = ("head_camera",)
    parameters = tuple(Parameter(name=a, unit="m", lower=-MOST, upper=MOST, typical=0.01) for a in "xyz")

    def sensors(self, sensors: SensorChanges, target: str, values: dict[str, float]) -> SensorChanges:
        """See `DressingEffect.sensors`."""
        return replace(sensors, camera=sensors.camera + [values[a] for a in "xyz"])

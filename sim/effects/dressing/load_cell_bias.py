"""A wrist's force sensor that does not read zero where nothing pulls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...sensors.sensor_changes import SensorChanges
from ...world import SIDES
from ..effect import Parameter
from .dressing_effect import DressingEffect

MOST = 20.0  # [N]


class LoadCellBias(DressingEffect):
    """Force that a sensor adds along the axes of its hand: x, y along the closing fingers, z out of the palm."""

    name = "load_cell_bias"
    targets = tuple(f"{side}_hand" for side in SIDES)
    parameters = tuple(Parameter(name=f"f{a}", unit="N", lower=-MOST, upper=MOST, typical=0.5) for a in "xyz")

    def sensors(self, sensors: SensorChanges, target: str, values: dict[str, float]) -> SensorChanges:
        """See `DressingEffect.sensors`."""
        more = np.zeros((2, 3))
        more[self.targets.index(target)] = [values[p.name] for p in self.parameters]
        return replace(sensors, bias=sensors.bias + more)

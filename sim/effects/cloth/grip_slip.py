"""Cloth that slips out of the first pin (a gripper, a clip)."""

from __future__ import annotations

from ..effect import Parameter
from .cloth_effect import ClothEffect


class GripSlip(ClothEffect):
    """The first pin lets go at `time`."""

    name = "grip_slip"
    parameters = (Parameter(name="time", unit="s", lower=0.0),)
    sentence = "cloth that slips out of the first pin"

    def release(self, values: dict[str, float]) -> float | None:
        """When it lets go [s]."""
        return values["time"]

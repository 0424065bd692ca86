"""Sensor effects on markers: a clock that lags, a frame that is shifted."""

from __future__ import annotations

import numpy as np

from ..effect import Parameter
from .cloth_effect import ClothEffect


class MarkerDelay(ClothEffect):
    """Markers are recorded `time` after they were there."""

    name = "delay"
    parameters = (Parameter(name="time", unit="s", lower=-0.5, upper=0.5),)
    sentence = "markers recorded later than they were there"

    def read(self, t: np.ndarray, markers: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """Markers of a little earlier, (T, M, 3)."""
        flat = markers.reshape(len(t), -1)
        late = np.stack([np.interp(t - values["time"], t, column) for column in flat.T], axis=1)
        return late.reshape(markers.shape)


class MarkerOffset(ClothEffect):
    """Markers are recorded in a frame shifted by (x, y, z)."""

    name = "offset"
    parameters = tuple(Parameter(name=a, unit="m", lower=-1.0, upper=1.0) for a in "xyz")
    sentence = "markers recorded in a shifted frame"

    def read(self, t: np.ndarray, markers: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """Shifted markers, (T, M, 3)."""
        return markers + np.array([values[a] for a in "xyz"])

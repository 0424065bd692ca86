"""Images that arrive late: what a camera saw is kept until it may be shown."""

from __future__ import annotations

from collections import deque
from typing import Generic, Protocol, TypeVar

import numpy as np

from ..scene import difficulties
from ..world import CAMERAS


class Stamped(Protocol):
    """Something that bears the time at which it was so."""

    @property
    def time(self) -> float:
        """World clock [s]."""
        ...


T = TypeVar("T", bound=Stamped)


class LateImages(Generic[T]):
    """What there was to see in the last moments, and since when each camera shows it.

    Every camera has a latency of its own for the whole run; the rest of an image's age is that the camera takes one
    only every now and then.

    Args:
        rng: of this difficulty alone.
        sizes: how late.

    Attributes:
        latency: by camera, age of an image when it arrives, at least [s].
        period: between two images [s].
    """

    def __init__(
        self, rng: np.random.Generator, sizes: difficulties.LateImages = difficulties.SIZES.late_images
    ) -> None:
        least, most = sizes.age
        self.period = sizes.period
        self.latency = {camera: float(rng.uniform(least, most - sizes.period)) for camera in CAMERAS}
        self._kept: deque[T] = deque(maxlen=int(most / sizes.period) + 2)

    def due(self, time: float) -> bool:
        """Whether the cameras take an image at `time` [s]."""
        return not self._kept or time >= self._kept[-1].time + self.period - 1e-9

    def keep(self, seen: T) -> None:
        """Remember what there is to see now."""
        self._kept.append(seen)

    def newest(self, camera: str, time: float) -> T | None:
        """The last of what a camera may show at `time` [s]; the first of all before that; None if there is nothing."""
        shown = [seen for seen in self._kept if seen.time <= time - self.latency[camera] + 1e-9]
        return shown[-1] if shown else next(iter(self._kept), None)

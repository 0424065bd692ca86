"""Watches whether the senses are alive: their time advances and their noise varies."""

from __future__ import annotations

import numpy as np

from ...sim.world import SIDES, Frame, Observation
from ...skills.core.reasons import Failure, Reason
from .limits import Limits


class Watchdog:
    """Judges whether samples go on coming, and whether samples and frames vary; their age is judged in `freshness.py`.

    A force sensor that repeats every bit is dead, not quiet: a world without noise on its wrenches is
    therefore stopped, in simulation too.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._fresh: float | None = None  # when the last sample with a new stamp came
        self._stamp = -np.inf
        self._wrench = np.full((2, 6), np.nan)
        self._varied = np.zeros(2)  # per hand, stamp of the last change
        self._frames: dict[str, tuple[float, int, int]] = {}  # camera -> stamp, content, repeats

    def sample(self, observation: Observation, now: float) -> None:
        """Take note of one observation."""
        if observation.time <= self._stamp:
            return
        first = not np.isfinite(self._stamp)
        self._stamp, self._fresh = observation.time, now
        for n in range(2):
            if first or not np.array_equal(observation.wrench_hand_in_map[n], self._wrench[n]):
                self._varied[n] = observation.time
        self._wrench = np.array(observation.wrench_hand_in_map, float)

    def judge(self, now: float) -> Failure | None:
        """The failure that must stop the run, if there is one."""
        if self._fresh is None:
            self._fresh = now  # nothing has come yet: count from the first question
        age = now - self._fresh
        if age > self._limits.stale_after:
            return Failure(Reason.SENSOR_STALE, f"no new joint state for {age:.1f} s", "guard")
        for n, side in enumerate(SIDES):
            still = self._stamp - self._varied[n]
            if still > self._limits.frozen_after:
                return Failure(Reason.SENSOR_STALE, f"the {side} wrench has not varied for {still:.1f} s", "guard")
        return None

    def frame(self, frame: Frame) -> str:
        """What is wrong with the camera, if its frames no longer vary; empty if nothing is."""
        content = hash(frame.depth.tobytes())
        stamp, last, repeats = self._frames.get(frame.camera, (-np.inf, 0, 0))
        if frame.stamp > stamp:
            repeats = repeats + 1 if content == last else 0
            self._frames[frame.camera] = (frame.stamp, content, repeats)
        if repeats >= self._limits.frozen_frames:
            return f"the {frame.camera} image has not varied in {repeats} frames"
        return ""

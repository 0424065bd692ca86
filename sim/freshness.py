"""Whether what a robot measured can be used: it is new enough, and it is numbers.

A robot that died leaves its last joint state behind, with fingers as open as they were: whoever reads it must be told
that it is lost.  Everybody who limits the age of what is measured asks here.
"""

from __future__ import annotations

import math
from dataclasses import fields
from operator import attrgetter

import numpy as np

from .world import Frame, Observation, SensorLost, SensorStale

NUMBERS = tuple(field.name for field in fields(Observation) if field.name not in ("time", "emergency_stop"))
_numbers = attrgetter(*NUMBERS)


def fresh_observation(seen: Observation, now: float, limit: float) -> Observation:
    """`seen` itself, if it can be used.

    Args:
        seen: of the robot.
        now: world clock [s].
        limit: older is lost [s].

    Raises:
        SensorStale: it is too old.
        SensorLost: it holds something that is no finite number.
    """
    if (age := now - seen.time) > limit:
        raise SensorStale(f"no new joint state for {age:.1f} s")
    if not math.isfinite(seen.time):
        raise SensorLost("the joint state has no time")
    numbers = np.concatenate(_numbers(seen), axis=None)
    if math.isfinite(numbers.dot(numbers)) or np.isfinite(numbers).all():  # at once: several times in every tick
        return seen
    name = next(name for name in NUMBERS if not np.isfinite(getattr(seen, name)).all())
    raise SensorLost(f"{name} of the joint state holds a number that is not finite")


def fresh_frame(frame: Frame, now: float, limit: float) -> Frame:
    """`frame` itself, if it can be used; the arguments and errors are those of `fresh_observation`."""
    if (age := now - frame.stamp) > limit:
        raise SensorStale(f"the {frame.camera} image is {age:.1f} s old")
    if not (np.isfinite(frame.stamp) and np.isfinite(frame.pose_camera_in_map).all()):
        raise SensorLost(f"the {frame.camera} image has no time or no place")
    return frame

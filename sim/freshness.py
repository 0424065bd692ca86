"""Whether what a robot measured can be used: it has its form, it is new enough, and it is numbers.

A robot that died leaves its last joint state behind, with fingers as open as they were: whoever reads it must be told
that it is lost.  Everybody who limits the age of what is measured asks here.
"""

from __future__ import annotations

import math
from dataclasses import fields
from operator import attrgetter

import numpy as np

from .observation_form import ObservationForm
from .world import Frame, Observation, SensorLost, SensorStale

AHEAD = 0.1  # [s] by which a stamp may be ahead: clocks of two computers differ by up to half of it (`robot doctor`)
NUMBERS = tuple(field.name for field in fields(Observation) if field.name not in ("time", "emergency_stop"))
_numbers = attrgetter(*NUMBERS)


def fresh_observation(seen: Observation, now: float, limit: float, form: ObservationForm) -> Observation:
    """`seen` itself, if it can be used.

    Args:
        seen: of the robot.
        now: world clock [s].
        limit: older is lost [s].
        form: of the observations of that robot.

    Raises:
        SensorStale: it is too old.
        SensorLost: it has not that form, was measured in the future, or holds something that is no finite number.
    """
    if fault := form.fault(seen):
        raise SensorLost(fault)
    if (age := now - seen.time) > limit:
        raise SensorStale(f"no new joint state for {age:.1f} s")
    if not math.isfinite(seen.time):
        raise SensorLost("the joint state has no time")
    if age < -AHEAD:
        raise SensorLost(f"the time of the joint state is {-age:.1f} s ahead of the clock")
    try:
        numbers = np.concatenate(_numbers(seen), axis=None)
    except TypeError:  # of texts and numbers
        numbers = np.array("")
    if numbers.dtype.kind not in "fiu":
        name = next(name for name in NUMBERS if np.asarray(getattr(seen, name)).dtype.kind not in "fiu")
        raise SensorLost(f"{name} of the joint state holds what is no number")
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
    if age < -AHEAD:
        raise SensorLost(f"the time of the {frame.camera} image is {-age:.1f} s ahead of the clock")
    return frame

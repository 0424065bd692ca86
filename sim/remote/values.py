"""Values of the contract as plain numbers, texts, arrays, tuples and dictionaries, and back.

What crosses to another process is taken apart and put together anew, so an object can bring nothing along that the
contract does not declare.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..errors import CaretreeError
from ..world import (
    BaseVelocity,
    EmergencyStop,
    Frame,
    GripperOpening,
    HandTwist,
    JointTrajectory,
    Observation,
    RoomMap,
    SensorLost,
    SensorStale,
    WorldError,
)

DECLARED = {
    kind.__name__: kind
    for kind in (Observation, Frame, RoomMap, JointTrajectory, HandTwist, BaseVelocity, GripperOpening)
}
ERRORS = {kind.__name__: kind for kind in (SensorStale, SensorLost, EmergencyStop, WorldError, CaretreeError)}


class UndeclaredError(CaretreeError):
    """A world gives away what its contract does not declare."""


def packed(value: Any) -> Any:
    """A value of the contract as plain numbers, texts, arrays, tuples and dictionaries.

    Raises:
        UndeclaredError: of another type, or with an attribute that its class does not declare.
    """
    if is_dataclass(value):
        name, names = type(value).__name__, {field.name for field in fields(value)}
        if DECLARED.get(name) is not type(value):
            raise UndeclaredError(f"a world gives a {name}, but its contract knows {', '.join(DECLARED)}")
        if more := sorted(vars(value).keys() - names):
            raise UndeclaredError(f"{name} has {', '.join(more)}, which the contract does not declare")
        return name, {field: packed(getattr(value, field)) for field in sorted(names)}
    if type(value) is np.ndarray and value.dtype.kind in "bifu":
        return value
    if isinstance(value, np.generic):
        return value.item()
    if type(value) in (list, tuple):
        return tuple(packed(each) for each in value)
    if type(value) is dict:
        return {str(key): packed(each) for key, each in value.items()}
    if value is None or type(value) in (bool, int, float, str):
        return value
    raise UndeclaredError(f"a world gives a {type(value).__name__}, but its contract declares none")


def unpacked(value: Any) -> Any:
    """The value again that `packed` took apart."""
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], dict) and value[0] in DECLARED:
        return DECLARED[value[0]](**{name: unpacked(each) for name, each in value[1].items()})
    return value

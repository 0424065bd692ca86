"""A robot's joint states in the encodings that logs have them in: ROS 1, ROS 2 and Foxglove's JSON."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass

import numpy as np

ROS_SCHEMAS = ("sensor_msgs/JointState", "sensor_msgs/msg/JointState")
SCHEMAS = (*ROS_SCHEMAS, "foxglove.JointStates")
HEADER = 4  # [bytes] in front of a message in CDR, from whose end alignment counts


@dataclass(frozen=True)
class JointState:
    """One message; what a joint does not tell is left out of its mapping.

    Attributes:
        t: [s].
        position: joint -> [rad] or [m].
        velocity: joint -> [rad/s] or [m/s].
        effort: joint -> [N m] or [N].
    """

    t: float
    position: dict[str, float]
    velocity: dict[str, float]
    effort: dict[str, float]


def from_ros1(data: bytes) -> JointState:
    """A `sensor_msgs/JointState` as ROS 1 sends it."""
    values = _Values(data)
    values.whole()  # the sequence number
    return _read(values)


def from_cdr(data: bytes) -> JointState:
    """A `sensor_msgs/msg/JointState` in CDR, the plain little-endian encoding of ROS 2."""
    return _read(_Values(data, at=HEADER, aligned=True))


def from_json(data: bytes) -> JointState:
    """A `foxglove.JointStates`."""
    message = json.loads(data)
    joints = message["joints"]
    parts = [
        {j["name"]: float(j[key]) for j in joints if j.get(key) is not None}
        for key in ("position", "velocity", "effort")
    ]
    return JointState(message["timestamp"]["sec"] + 1e-9 * message["timestamp"]["nsec"], *parts)


class _Values:
    """Takes one value after the other out of a message; aligned ones begin at a multiple of their size."""

    def __init__(self, data: bytes, at: int = 0, aligned: bool = False) -> None:
        self._data, self._at, self._aligned = data, at, aligned

    def whole(self) -> int:
        """An unsigned whole number of 4 bytes."""
        self._align(4)
        value = struct.unpack_from("<I", self._data, self._at)[0]
        self._at += 4
        return value

    def text(self) -> str:
        """A string; that of CDR ends with a zero."""
        size = self.whole()
        value = self._data[self._at : self._at + size]
        self._at += size
        return value.rstrip(b"\0").decode()

    def numbers(self) -> np.ndarray:
        """A sequence of float64."""
        count = self.whole()
        if count:
            self._align(8)
        values = np.frombuffer(self._data, "<f8", count, self._at)
        self._at += 8 * count
        return values

    def _align(self, size: int) -> None:
        if self._aligned:
            self._at = HEADER + -(-(self._at - HEADER) // size) * size


def _read(values: _Values) -> JointState:
    t = values.whole() + 1e-9 * values.whole()
    values.text()  # the frame
    names = [values.text() for _ in range(values.whole())]
    # a sensor that is not there is an empty sequence
    position, velocity, effort = (dict(zip(names, values.numbers().tolist(), strict=False)) for _ in range(3))
    return JointState(t, position, velocity, effort)

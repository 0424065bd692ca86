"""A log read back: what the robot measured, saw and was sent, as arrays over time."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import RecordError
from ..extras import need
from ..world import SIDES
from .messages import ROBOT

JOINTS, MEASURED, SENT = "/joint_states", "/measured", "/sent"
CAMERA_TOPIC = "_camera/image"
NO_LOG = "is no log of this version: record it with `caretree run TASK --log`"


@dataclass(frozen=True, kw_only=True)
class JointRoles:
    """Which joint is what.

    Attributes:
        arms: of the left arm, then of the right one.
        fingers: both of the left hand, then both of the right one.
        head: that turns the head.
        base: x, y and yaw of the base in the map.
    """

    arms: tuple[str, ...]
    fingers: tuple[tuple[str, ...], tuple[str, ...]]
    head: str
    base: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Picture:
    """One picture of a camera, packed as it lies in the log.

    Attributes:
        time: of its exposure [s].
        data: JPEG, or bytes of red, green and blue.
        shape: (height, width) [px] of such bytes; None for a JPEG, which knows its own.
    """

    time: float
    data: bytes
    shape: tuple[int, int] | None = None

    def rgb(self) -> np.ndarray:
        """(H, W, 3) uint8.

        Raises:
            RecordError: it is damaged.
        """
        if self.shape is not None:
            return np.frombuffer(self.data, np.uint8).reshape(*self.shape, 3)
        import cv2

        found = cv2.imdecode(np.frombuffer(self.data, np.uint8), cv2.IMREAD_COLOR)
        if found is None:
            raise RecordError(f"the picture at {self.time:.2f} s is damaged")
        return np.ascontiguousarray(found[:, :, ::-1])


@dataclass(frozen=True, kw_only=True, eq=False)
class RobotLog:
    """What one log holds; a number that the robot did not know is NaN.

    Attributes:
        path: of the file.
        robot: its name.
        roles: of its joints.
        t: (T,) when it measured itself [s].
        joints: name -> (T, 3) position, velocity and effort [rad or m, per second, N m or N].
        twist_base: (T, 3) velocity in the base frame [m/s, m/s, rad/s].
        wrench_hand: (T, 2, 6) load on each hand along the map's axes [N, N m].
        sent: every command as it was really sent, and every stop, in order.
        pictures: camera -> its pictures in order.
    """

    path: Path
    robot: str
    roles: JointRoles
    t: np.ndarray
    joints: dict[str, np.ndarray]
    twist_base: np.ndarray
    wrench_hand: np.ndarray
    sent: list[tuple[float, dict[str, Any]]]
    pictures: dict[str, list[Picture]]


def read_log(path: Path) -> RobotLog:
    """The log in a file.

    Raises:
        MissingExtra: the package `mcap` is not installed.
        RecordError: it is not there, cut short, or not written by this version's `--log`.
    """
    need("mcap", "reading a log")
    from mcap.exceptions import McapError

    if not path.is_file():
        raise RecordError(f"{path}: no such file")
    try:
        robot, messages = _read(path)
    except (McapError, EOFError, struct.error) as error:
        raise RecordError(f"{path} is no whole MCAP file ({error}); `mcap recover` mends one cut short") from error
    if robot is None:
        raise RecordError(f"{path} {NO_LOG}")
    try:
        return _log(path, robot, messages)
    except (KeyError, TypeError, ValueError) as error:
        raise RecordError(f"{path} {NO_LOG} ({type(error).__name__}: {error})") from error


def _read(path: Path) -> tuple[dict[str, Any] | None, dict[str, list[dict[str, Any]]]]:
    from mcap.reader import make_reader

    robot, messages = None, {}
    with path.open("rb") as file:
        reader = make_reader(file)
        for attachment in reader.iter_attachments():
            if attachment.name == ROBOT:
                robot = json.loads(attachment.data)
        for _, channel, message in reader.iter_messages(log_time_order=True):
            wanted = channel.topic in (JOINTS, MEASURED, SENT) or channel.topic.endswith(CAMERA_TOPIC)
            if wanted and channel.message_encoding == "json":
                messages.setdefault(channel.topic, []).append(json.loads(message.data))
    return robot, messages


def _log(path: Path, robot: dict[str, Any], messages: dict[str, list[dict[str, Any]]]) -> RobotLog:
    states, rest = messages.get(JOINTS, []), messages.get(MEASURED, [])
    if not states or len(states) != len(rest):
        raise RecordError(f"{path} {NO_LOG}")
    names = [joint["name"] for joint in states[0]["joints"]]
    told = [
        [[joint.get(kind) for kind in ("position", "velocity", "effort")] for joint in each["joints"]]
        for each in states
    ]
    rows = _numbers(told)
    fingers = robot["fingers"]
    return RobotLog(
        path=path,
        robot=robot["name"],
        roles=JointRoles(
            arms=tuple(name for side in SIDES for name in robot["arms"][side]),
            fingers=(tuple(fingers["left"]), tuple(fingers["right"])),
            head=robot["head"],
            base=tuple(robot["base"]),
        ),
        t=np.array([_seconds(each) for each in states]),
        joints={name: rows[:, k] for k, name in enumerate(names)},
        twist_base=_numbers([list(each["twist_in_base"].values()) for each in rest]),
        wrench_hand=_numbers([[list(_loads(each[f"{side}_hand"])) for side in SIDES] for each in rest]),
        sent=[(_seconds(each), each) for each in messages.get(SENT, [])],
        pictures={
            topic.removeprefix("/").removesuffix(CAMERA_TOPIC): [_picture(each) for each in seen]
            for topic, seen in messages.items()
            if topic.endswith(CAMERA_TOPIC)
        },
    )


def _seconds(content: dict[str, Any]) -> float:
    return content["timestamp"]["sec"] + 1e-9 * content["timestamp"]["nsec"]


def _numbers(rows: list[Any]) -> np.ndarray:
    """JSON's null becomes NaN."""
    return np.array(rows, dtype=object).astype(float)


def _loads(hand: dict[str, dict[str, float]]) -> Iterator[float]:
    for kind in ("force", "torque"):
        yield from (hand[kind][axis] for axis in "xyz")


def _picture(content: dict[str, Any]) -> Picture:
    shape = (content["height"], content["width"]) if "encoding" in content else None
    return Picture(time=_seconds(content), data=base64.b64decode(content["data"]), shape=shape)


def held(t: np.ndarray, times: Iterable[float]) -> np.ndarray:
    """(N,) index, for each of `t` (N,), of the latest of growing `times` that is not after it; -1 before the first."""
    return np.searchsorted(np.asarray(list(times), float), t, side="right") - 1

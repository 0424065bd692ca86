"""Logs of a robot's joints, MCAP or ROS 1 bag, as a measurement set of system `arm`."""

from __future__ import annotations

import fnmatch
import struct
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....sim.log.logged_world import URDF
from ..errors import GapError
from ..joints.robot_files import find_urdf
from .joint_state import SCHEMAS, JointState, from_cdr, from_json, from_ros1
from .ros_bag import read_bag
from .setting import write_set

FIT = 0.6  # part of a single log that may be fitted to; the rest is held out (optimistic: it is the same run)
DECODERS: dict[str, Callable[[bytes], JointState]] = {"json": from_json, "cdr": from_cdr, "ros1": from_ros1}
UNREADABLE = (struct.error, KeyError, TypeError, ValueError, IndexError)


@dataclass(frozen=True)
class JointLog:
    """What one log tells of a robot's joints.

    Attributes:
        path: of the log.
        topics: topic -> its messages.
        urdf: the robot's, where the log brings it.
    """

    path: Path
    topics: dict[str, list[JointState]]
    urdf: str | None = None


def import_logs(
    paths: Sequence[Path], out: Path, joints: Sequence[str], robot: str | None = None, topic: str | None = None
) -> Path:
    """Write a measurement set of logs, one recording each; a single log is cut in two.

    Args:
        paths: logs, `.mcap` or `.bag`; of several the last third is held out.
        out: folder of the set.
        joints: names, or patterns such as `left_*`; only joints of the URDF that tell their effort count.
        robot: URDF file, or a name in example-robot-data; None for what the log brings.
        topic: of the joint states, where there are several.

    Returns:
        The folder.

    Raises:
        GapError: a log cannot be read, or does not have these joints.
    """
    logs = [read_log(path) for path in paths]
    text = _urdf(logs, out, robot)
    states = [_of_topic(log, topic) for log in logs]
    names = _chain(text, _matching(logs[0].path, states[0], joints, text))
    episodes: list[tuple[str, str, dict[str, np.ndarray]]] = []
    held = len(logs) - max(1, len(logs) // 3)
    for k, (log, of_log) in enumerate(zip(logs, states, strict=True)):
        columns = _columns(log.path, of_log, names)
        if len(logs) > 1:
            episodes.append((f"{log.path.stem}_{k + 1}", "heldout" if k >= held else "fit", columns))
            continue
        cut = int(FIT * len(columns["t"]))
        for name, role, rows in (("first", "fit", slice(0, cut)), ("second", "heldout", slice(cut, None))):
            episodes.append((name, role, {key: values[rows] for key, values in columns.items()}))
    out.mkdir(parents=True, exist_ok=True)
    (out / URDF).write_text(_with_joints(text, names), encoding="utf-8")
    return write_set(out, {"system": "arm", "robot": URDF}, episodes)


def read_log(path: Path) -> JointLog:
    """The joint states of a log.

    Raises:
        GapError: it is not there, is no log, is damaged, or has no joint states.
    """
    if not path.is_file():
        raise GapError(f"{path}: no such file")
    topics: dict[str, list[JointState]] = {}
    urdf = None
    try:
        if path.suffix == ".bag":
            found = ((topic, "ros1", data) for topic, kind, data in read_bag(path) if kind in SCHEMAS)
        else:
            found, urdf = _mcap(path)
        for topic, encoding, data in found:
            topics.setdefault(topic, []).append(DECODERS[encoding](data))
    except UNREADABLE as error:
        raise GapError(f"{path}: a joint state cannot be read ({type(error).__name__}: {error})") from error
    if not topics:
        raise GapError(f"{path}: has no joint states ({', '.join(SCHEMAS)})")
    return JointLog(path, topics, urdf)


def _mcap(path: Path) -> tuple[Iterator[tuple[str, str, bytes]], str | None]:
    from mcap.exceptions import McapError
    from mcap.reader import make_reader

    rows, urdf = [], None
    try:
        with path.open("rb") as file:
            reader = make_reader(file)
            for attachment in reader.iter_attachments():
                if attachment.name == URDF:
                    urdf = attachment.data.decode()
            for schema, channel, message in reader.iter_messages():
                if schema is not None and schema.name in SCHEMAS and channel.message_encoding in DECODERS:
                    rows.append((channel.topic, channel.message_encoding, message.data))
    except (McapError, EOFError) as error:
        raise GapError(f"{path}: is no whole MCAP file ({error}); `mcap recover` mends one cut short") from error
    return iter(rows), urdf


def _urdf(logs: Sequence[JointLog], out: Path, robot: str | None) -> str:
    if robot is not None:
        return find_urdf(robot, out).read_text(encoding="utf-8")
    text = next((log.urdf for log in logs if log.urdf is not None), None)
    if text is None:
        raise GapError(f"{logs[0].path}: the log does not bring the robot's URDF, name one with --robot")
    return text


def _of_topic(log: JointLog, topic: str | None) -> list[JointState]:
    if topic is None and len(log.topics) == 1:
        return next(iter(log.topics.values()))
    if topic not in log.topics:
        given = "there are several topics" if topic is None else f"there is no topic {topic}"
        raise GapError(f"{log.path}: {given} of joint states, name one with --topic: {', '.join(sorted(log.topics))}")
    return log.topics[topic]


def _matching(path: Path, states: list[JointState], patterns: Sequence[str], text: str) -> list[str]:
    """Joints that are asked for, move in the URDF, and tell what the set needs."""
    movable = {joint.get("name", "") for joint in _joints(text)}
    told = {name for state in states for name in state.position if name in state.effort and name in movable}
    names = sorted({name for pattern in patterns for name in fnmatch.filter(told, pattern)})
    if not names:
        raise GapError(
            f"{path}: no joint of the robot with position and effort is called {' or '.join(patterns)}; there are "
            f"{', '.join(sorted(told)) or 'none'}"
        )
    return names


def _columns(path: Path, states: list[JointState], names: list[str]) -> dict[str, np.ndarray]:
    """Columns of a set, at growing times, where all joints are told."""
    whole = [s for s in states if all(name in s.position and name in s.effort for name in names)]
    t = np.array([state.t for state in whole])
    newest = np.maximum.accumulate(t) if len(t) else t
    keep = np.concatenate([np.ones(min(1, len(t)), bool), t[1:] > newest[:-1]])
    whole = [state for state, kept in zip(whole, keep, strict=True) if kept]
    if len(whole) < 2:
        raise GapError(f"{path}: tells of {', '.join(names)} together less than twice")
    columns = {"t": t[keep] - t[0]}
    columns |= {f"q{j + 1}": np.array([s.position[name] for s in whole]) for j, name in enumerate(names)}
    if all(name in state.velocity for state in whole for name in names):
        columns |= {f"dq{j + 1}": np.array([s.velocity[name] for s in whole]) for j, name in enumerate(names)}
    return columns | {f"tau{j + 1}": np.array([s.effort[name] for s in whole]) for j, name in enumerate(names)}


def _joints(text: str) -> list[ET.Element]:
    """Joints of a URDF that move.

    Raises:
        GapError: it is none.
    """
    try:
        robot = ET.fromstring(text)
    except ET.ParseError as error:
        raise GapError(f"the robot's URDF cannot be read: {error}") from error
    return [joint for joint in robot.findall("joint") if joint.get("type") != "fixed"]


def _chain(text: str, names: list[str]) -> list[str]:
    """The same names from base to hand: the order in which the model counts them."""
    parents = {_link(joint, "child"): joint for joint in ET.fromstring(text).findall("joint")}

    def depth(name: str) -> int:
        joint, count = next(j for j in parents.values() if j.get("name") == name), 0
        while (above := parents.get(_link(joint, "parent"))) is not None:
            joint, count = above, count + 1
        return count

    return sorted(names, key=depth)


def _link(joint: ET.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _with_joints(text: str, names: list[str]) -> str:
    """The URDF with these joints alone; every other one is fixed where it is at 0."""
    robot = ET.fromstring(text)
    for joint in robot.findall("joint"):
        if joint.get("name") not in names:
            joint.set("type", "fixed")
    return ET.tostring(robot, encoding="unicode")

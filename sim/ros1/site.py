"""What differs from one robot and one room to the next, read from one YAML file a site: topics, joints, calibration.

`sites/baxter.yaml` beside this file is the example, and what `caretree serve-robot` answers to.
"""

from __future__ import annotations

import difflib
from dataclasses import MISSING, dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np
import yaml

from ..world import WorldError
from ..yaml_text import load_yaml

SITES = Path(__file__).parent / "sites"
DEFAULT = "baxter"
Point = tuple[float, float, float]


class SiteError(WorldError):
    """A site file is not as it should be; the message says where, and what is asked for."""


@dataclass(frozen=True, kw_only=True)
class JointStates:
    """Positions, velocities and efforts of all arm joints and the head, in one message."""

    topic: str
    rate: float  # [Hz] at least


@dataclass(frozen=True, kw_only=True)
class Arm:
    """One arm: its joints, shoulder to wrist, and who moves them.

    Attributes:
        joints: names in the joint states and in trajectories.
        zero: what the encoders read where the model has 0 (n,) [rad].
        trajectory: a FollowJointTrajectory action.
        velocity: takes joint velocities for 0.2 s each.
    """

    joints: tuple[str, ...]
    zero: tuple[float, ...]
    trajectory: str
    velocity: str


@dataclass(frozen=True, kw_only=True)
class Head:
    """The head: its joint, and a SingleJointPosition action that turns it."""

    joint: str
    action: str
    speed: float  # [rad/s] at most


@dataclass(frozen=True, kw_only=True)
class Gripper:
    """One gripper: a GripperCommand action, and a joint state with the opening [m] and the squeezing force [N]."""

    action: str
    state: str
    joint: str
    stroke: float  # [m]
    force: tuple[float, float]  # [N]
    rate: float  # [Hz] at least


@dataclass(frozen=True, kw_only=True)
class Wrist:
    """One force sensor: where it sits, and what hangs on it all the time.

    Attributes:
        topic: of stamped wrenches in the sensor's own axes.
        frame: that their header names.
        xyz: of the sensor in the hand frame [m].
        rpy: of the sensor's axes in those of the hand [rad].
        mass: of what the sensor carries: gripper and cables [kg].
        centre: of that mass in the hand frame [m].
        zero: what the unloaded sensor reads (6,) [N], [N m].
        rate: [Hz] at least.
    """

    topic: str
    frame: str
    xyz: Point
    rpy: Point
    mass: float
    centre: Point
    zero: tuple[float, float, float, float, float, float]
    rate: float


@dataclass(frozen=True, kw_only=True)
class Base:
    """The base: what drives it, and what says where it is.

    Attributes:
        command: takes a velocity for 0.25 s each.
        odometry: pose in `odometry_frame`, velocity in the base's own axes.
        pose: of the base in `map_frame`, whenever there is one; odometry carries it on.
        speed: greatest, [m/s] and [rad/s].
        rate: of the odometry, [Hz] at least.
    """

    command: str
    odometry: str
    pose: str
    odometry_frame: str
    map_frame: str
    speed: tuple[float, float]
    rate: float


@dataclass(frozen=True, kw_only=True)
class Camera:
    """An RGB-D camera whose depth is aligned with its colours.

    Attributes:
        colour: rgb8 or bgr8 images.
        depth: 16UC1 [mm] or 32FC1 [m].
        info: its intrinsics.
        frame: that their headers name.
        xyz: where it really is, in the optical frame that the robot's model has for it [m].
        rpy: how it is really turned there [rad].
        rate: [Hz] at least.
    """

    colour: str
    depth: str
    info: str
    frame: str
    xyz: Point
    rpy: Point
    rate: float


@dataclass(frozen=True, kw_only=True)
class State:
    """Whether the robot is enabled, stopped, or its emergency stop is pressed."""

    topic: str
    rate: float  # [Hz] at least


@dataclass(frozen=True, kw_only=True)
class Room:
    """The map: an occupancy grid, free where the base's centre may be; the rest here, or a parameter of the master.

    Attributes:
        grid: topic.
        annotations: parameter with `waypoints` (name -> x, y, yaw) and `bed` (lower and upper corner) [m], [rad].
    """

    grid: str
    annotations: str


@dataclass(frozen=True, kw_only=True)
class Site:
    """All of it; in `arms` and the like the keys are `left` and `right`, in `cameras` names of the contract.

    Attributes:
        robot: whose model the planner and the guard use.
        alive: topic that says until when the tree waits; who hears nothing there for 0.3 s stops the robot.
        fresh: [s] older than that is too old, for the doctor.
    """

    robot: str
    alive: str
    fresh: float
    joint_states: JointStates
    arms: dict[str, Arm]
    head: Head
    grippers: dict[str, Gripper]
    wrists: dict[str, Wrist]
    base: Base
    cameras: dict[str, Camera]
    state: State
    room: Room


ROBOTS = {"baxter": 7}  # with a model, and the joints of each arm
KEYS = {"arms": ("left", "right"), "grippers": ("left", "right"), "wrists": ("left", "right")}
CAMERA_NAMES = ("head", "left_hand", "right_hand")


def read_site(name: str = DEFAULT) -> Site:
    """The site in a file, or the one of that name that comes with the package.

    Raises:
        SiteError: it is not there, or not as it should be.
    """
    path = Path(name) if name.endswith((".yaml", ".yml")) else SITES / f"{name}.yaml"
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        there = ", ".join(sorted(each.stem for each in SITES.glob("*.yaml")))
        raise SiteError(f"no site {name!r}: {error.strerror} ({path}); there are {there}, or give a .yaml") from error
    except yaml.MarkedYAMLError as error:
        line = f":{error.problem_mark.line + 1}" if error.problem_mark else ""
        raise SiteError(f"{path}{line}: {error.problem}") from error
    site: Site = _read(Site, content, str(path), "")
    _check(site, str(path))
    return site


def _read(kind: Any, value: Any, path: str, where: str) -> Any:
    if is_dataclass(kind):
        return _read_parts(kind, value, path, where)
    if get_origin(kind) is dict:
        if not isinstance(value, dict):
            raise SiteError(f"{path}: {where} is {value!r}, but a block for each is asked for")
        return {str(key): _read(get_args(kind)[1], each, path, f"{where}.{key}") for key, each in value.items()}
    if get_origin(kind) is tuple:
        kinds = get_args(kind)
        open_end = kinds[-1] is Ellipsis
        what = f"{'a list' if open_end else f'{len(kinds)}'} of {'text' if kinds[0] is str else 'numbers'}"
        if not isinstance(value, list) or not (open_end or len(value) == len(kinds)):
            raise SiteError(f"{path}: {where} is {value!r}, but {what} is asked for")
        return tuple(_read(kinds[0], each, path, f"{where}[{n}]") for n, each in enumerate(value))
    if kind is float and isinstance(value, (int, float)) and not isinstance(value, bool) and np.isfinite(value):
        return float(value)
    if kind is str and isinstance(value, str) and value.strip():
        return value
    raise SiteError(f"{path}: {where} is {value!r}, but {'a number' if kind is float else 'a text'} is asked for")


def _read_parts(kind: Any, value: Any, path: str, where: str) -> Any:
    named = f"{where}." if where else ""
    if not isinstance(value, dict):
        raise SiteError(f"{path}: {where or 'the file'} is {value!r}, but a block of settings is asked for")
    hints = get_type_hints(kind)
    for key in value:
        if key not in hints:
            alike = difflib.get_close_matches(str(key), list(hints), n=1)
            meant = f"; {alike[0]} is meant?" if alike else ""
            raise SiteError(f"{path}: {named}{key} is unknown; there are {', '.join(hints)}{meant}")
    for each in fields(kind):
        if each.name not in value and each.default is MISSING:
            raise SiteError(f"{path}: {named}{each.name} is missing")
    return kind(**{key: _read(hints[key], each, path, f"{named}{key}") for key, each in value.items()})


def _check(site: Site, path: str) -> None:
    """What no type tells."""
    if site.robot not in ROBOTS:
        raise SiteError(f"{path}: robot is {site.robot!r}, but there are models of {', '.join(ROBOTS)}")
    for name, keys in KEYS.items():
        if set(getattr(site, name)) != set(keys):
            raise SiteError(f"{path}: {name} has {', '.join(getattr(site, name))}, but left and right are asked for")
    for name in site.cameras:
        if name not in CAMERA_NAMES:
            raise SiteError(f"{path}: cameras.{name} is unknown; there are {', '.join(CAMERA_NAMES)}")
    for side, arm in site.arms.items():
        for what in ("joints", "zero"):
            if len(getattr(arm, what)) != ROBOTS[site.robot]:
                given = len(getattr(arm, what))
                raise SiteError(
                    f"{path}: arms.{side}.{what} has {given}, but {ROBOTS[site.robot]} are asked for: {site.robot}'s"
                )
    taken: dict[str, str] = {}
    for where, topic in _topics(site):
        if not topic.startswith("/"):
            raise SiteError(f"{path}: {where} is {topic!r}, but a name that begins with / is asked for")
        if topic in taken:
            raise SiteError(f"{path}: {where} and {taken[topic]} are both {topic}")
        taken[topic] = where
    for where, number in _positive(site):
        if number <= 0.0:
            raise SiteError(f"{path}: {where} is {number:g}, but more than 0 is asked for")


def _topics(site: Site) -> list[tuple[str, str]]:
    """Where each name of a topic or an action stands."""
    found = [("alive", site.alive), ("joint_states.topic", site.joint_states.topic), ("head.action", site.head.action)]
    found += [("state.topic", site.state.topic), ("room.grid", site.room.grid)]
    found += [(f"base.{name}", getattr(site.base, name)) for name in ("command", "odometry", "pose")]
    for side in ("left", "right"):
        found += [(f"arms.{side}.{name}", getattr(site.arms[side], name)) for name in ("trajectory", "velocity")]
        found += [(f"grippers.{side}.{name}", getattr(site.grippers[side], name)) for name in ("action", "state")]
        found.append((f"wrists.{side}.topic", site.wrists[side].topic))
    for name, camera in site.cameras.items():
        found += [(f"cameras.{name}.{part}", getattr(camera, part)) for part in ("colour", "depth", "info")]
    return found


def _positive(site: Site) -> list[tuple[str, float]]:
    found = [("fresh", site.fresh), ("joint_states.rate", site.joint_states.rate), ("head.speed", site.head.speed)]
    found += [("state.rate", site.state.rate), ("base.rate", site.base.rate)]
    found += [("base.speed[0]", site.base.speed[0]), ("base.speed[1]", site.base.speed[1])]
    for side in ("left", "right"):
        gripper = site.grippers[side]
        found += [(f"grippers.{side}.stroke", gripper.stroke), (f"grippers.{side}.rate", gripper.rate)]
        found += [(f"wrists.{side}.rate", site.wrists[side].rate)]
        found += [(f"grippers.{side}.force[1] - force[0]", gripper.force[1] - gripper.force[0])]
    return found + [(f"cameras.{name}.rate", camera.rate) for name, camera in site.cameras.items()]


def transform(xyz: Point, rpy: Point) -> np.ndarray:
    """Pose (4, 4) from a place [m] and turns about x, then y, then z of the outer frame [rad], as URDF has it."""
    (a, b, c), pose = rpy, np.eye(4)
    ca, sa, cb, sb, cc, sc = np.cos(a), np.sin(a), np.cos(b), np.sin(b), np.cos(c), np.sin(c)
    pose[:3, :3] = (
        (cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa),
        (sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa),
        (-sb, cb * sa, cb * ca),
    )
    pose[:3, 3] = xyz
    return pose

"""The World contract: everything a skill may touch, in simulation and on hardware alike.

Frames: `map` is the room (origin on the floor under the middle of the bed, x across the bed towards
the person's right, y from head to feet, z up).  `base` is the robot's base on the floor (x forward,
y left, z up).  `hand` is the point midway between the fingertips (z out of the palm, y along the
closing direction).  Units are SI.  A world may be late, a sensor may be missing, and time does not wait.
"""

from __future__ import annotations

import abc
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from .errors import CaretreeError
from .mechanics.robot_model import RobotModel

Side = Literal["left", "right"]
Hands = Literal["left", "right", "both"]  # of the robot
SIDES: tuple[Side, Side] = ("left", "right")
CAMERAS = ("head", "left_hand", "right_hand")


class WorldError(CaretreeError):
    """A world could not do what was asked; the message is one sentence for the operator."""


class SensorLost(WorldError):  # noqa: N818 it names a state of the robot, as operators say it
    """A sensor gave nothing: no frame, no joint state, no wrench."""


class SensorStale(SensorLost):
    """A sensor gave what it gave long ago."""


class EmergencyStop(WorldError):  # noqa: N818 it names a state of the robot, as operators say it
    """The emergency stop is pressed: nothing moves before a person has released it."""


@dataclass(frozen=True, kw_only=True)
class Observation:
    """What the robot measures of itself at one instant; each of its arms has n joints.

    Attributes:
        time: world clock when the sample was taken [s].
        arm_positions: (2, n) joint angles, left then right, order `robot.arm_joints` [rad].
        arm_velocities: (2, n) [rad/s].
        arm_efforts: (2, n) [N m].
        head_pan: angle of the head [rad].
        pose_base_in_map: (3,) x [m], y [m], yaw [rad].
        twist_base: (3,) velocity in the base frame [m/s, m/s, rad/s].
        gripper_opening: (2,) distance between the fingertips [m].
        gripper_force: (2,) squeezing force between the fingertips [N].
        wrench_hand_in_map: (2, 6) load on each hand, force [N] then torque [N m], own weight removed.
        pose_hand_in_map: (2, 4, 4) from the joint angles (forward kinematics, not truth).
        emergency_stop: whether it is pressed, or has been and the robot is not enabled again.
    """

    time: float
    arm_positions: np.ndarray
    arm_velocities: np.ndarray
    arm_efforts: np.ndarray
    head_pan: float
    pose_base_in_map: np.ndarray
    twist_base: np.ndarray
    gripper_opening: np.ndarray
    gripper_force: np.ndarray
    wrench_hand_in_map: np.ndarray
    pose_hand_in_map: np.ndarray
    emergency_stop: bool = False


@dataclass(frozen=True, kw_only=True)
class Frame:
    """One RGB-D image.

    Attributes:
        camera: one of `CAMERAS`.
        stamp: world clock at exposure [s].
        rgb: (H, W, 3) uint8.
        depth: (H, W) float32, distance along the optical axis [m]; 0 where there is none.
        intrinsics: (fx, fy, cx, cy) [px].
        pose_camera_in_map: (4, 4), optical frame: x right, y down, z forward.
    """

    camera: str
    stamp: float
    rgb: np.ndarray
    depth: np.ndarray
    intrinsics: tuple[float, float, float, float]
    pose_camera_in_map: np.ndarray


@dataclass(frozen=True, kw_only=True)
class JointTrajectory:
    """Timed joint motion.

    Attributes:
        joints: (m,) names out of the robot's `commanded_joints`; the world checks that.
        times: (k,) from the start of the motion, k >= 2, increasing, first is 0 [s].
        positions: (k, m) [rad].
    """

    joints: tuple[str, ...]
    times: np.ndarray
    positions: np.ndarray

    def __post_init__(self) -> None:
        """Refuse what no robot can do."""
        if not self.joints or len(set(self.joints)) < len(self.joints):
            raise WorldError(
                f"a trajectory moves {', '.join(self.joints) or 'nothing'}, but different joints are asked for"
            )
        count = len(np.atleast_1d(self.times))
        _check_numbers("times of a trajectory", self.times, (count,))
        _check_numbers("positions of a trajectory", self.positions, (count, len(self.joints)))
        if count < 2 or self.times[0] != 0.0 or not (np.diff(self.times) > 0.0).all():
            shown = np.round(self.times[:4], 3).tolist()
            raise WorldError(
                f"times of a trajectory are {shown}, but two and more that begin at 0 and grow are asked for"
            )

    def check_joints(self, robot: RobotModel) -> None:
        """Refuse what a robot cannot do.

        Raises:
            WorldError: it does not have one of the joints.
        """
        for joint in self.joints:
            if joint not in robot.commanded_joints:
                raise WorldError(
                    f"the robot {robot.name} has no joint {joint!r}; it has {robot.head_joint} and left_ or right_ "
                    f"with {', '.join(robot.arm_joints)}"
                )


@dataclass(frozen=True, kw_only=True)
class HandTwist:
    """Cartesian velocity of one hand in the map frame, held for `duration` [s] and then zero.

    twist_in_map: (6,) linear [m/s], angular [rad/s] of the `hand` point.
    """

    side: Side
    twist_in_map: np.ndarray
    duration: float = 0.2

    def __post_init__(self) -> None:
        """Refuse what no robot can do."""
        _check_side(self.side)
        _check_numbers("a twist", self.twist_in_map, (6,))
        _check_duration(self.duration)


@dataclass(frozen=True, kw_only=True)
class BaseVelocity:
    """Velocity of the holonomic base in the base frame (3,) [m/s, m/s, rad/s], held for `duration` [s]."""

    velocity: np.ndarray
    duration: float = 0.2

    def __post_init__(self) -> None:
        """Refuse what no robot can do."""
        _check_numbers("the base's velocity", self.velocity, (3,))
        _check_duration(self.duration)


@dataclass(frozen=True, kw_only=True)
class GripperOpening:
    """Drive the fingertips of one hand to `opening` [m], squeezing with at most `force_limit` [N]."""

    side: Side
    opening: float
    force_limit: float = 30.0

    def __post_init__(self) -> None:
        """Refuse what no robot can do."""
        _check_side(self.side)
        for what, value in (("opening [m]", self.opening), ("force limit [N]", self.force_limit)):
            if not 0.0 <= value < np.inf:
                raise WorldError(f"the {what} of the {self.side} gripper is {value}, but 0 or more is asked for")


def _check_side(side: str) -> None:
    if side not in SIDES:
        raise WorldError(f"side is {side!r}, but {' or '.join(SIDES)} is asked for")


def _check_numbers(what: str, values: np.ndarray, shape: tuple[int, ...]) -> None:
    if np.shape(values) != shape:
        raise WorldError(f"{what} has shape {np.shape(values)}, but {shape} is asked for")
    if not np.isfinite(values).all():
        raise WorldError(f"{what} holds a number that is not finite")


def _check_duration(duration: float) -> None:
    if not 0.0 <= duration < np.inf:
        raise WorldError(f"duration is {duration} s, but 0 or more is asked for")


Command = JointTrajectory | HandTwist | BaseVelocity | GripperOpening


class Clock(Protocol):
    """The world's time, the only time anything in the project uses."""

    def now(self) -> float:
        """Seconds since the world started; never less than before."""
        ...

    def wait_until(self, time: float) -> None:
        """Return when `now() >= time` [s]: a simulation advances itself, hardware waits.

        Where time passes by itself this returns within 0.1 s of wall time, whatever the clock does: it may be slow, or
        stand still, and whoever waits has more to watch.  So it may return early: `waiting.py` asks again.
        """
        ...


@dataclass(frozen=True)
class RoomMap:
    """What was mapped and annotated beforehand, as for any mobile robot.

    Attributes:
        free: (rows, cols) bool, True where the centre of the base may be.
        origin: (2,) map coordinates of cell [0, 0] [m]; rows run along y, columns along x.
        resolution: edge of a cell [m].
        waypoints: name -> (x, y, yaw) [m, m, rad]: `rail`, `bed_right`, `bed_left`, `start`.
        bed: (2, 3) lower and upper corner of the bed [m], nominal.
    """

    free: np.ndarray
    origin: np.ndarray
    resolution: float
    waypoints: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    bed: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))


class World(abc.ABC):
    """A body and its senses.  Simulation and hardware subclass this and nothing else.

    Calls come from one thread, but for `stop`: the watchdog calls it from its own, at any time, also while another
    call is under way.  Whether a world keeps the contract, `caretree.sim.testing.check_world` tells.

    Attributes:
        clock: of this world; a `SteppedClock` stands still until somebody waits, any other one is a wall clock.
        room: what was mapped beforehand.
        robot: what it is made of; skills plan with it.
    """

    clock: Clock
    room: RoomMap
    robot: RobotModel

    @abc.abstractmethod
    def observe(self) -> Observation:
        """Latest proprioception, with the time at which it was measured; its arrays stay as they are.

        An old one may be given again: whoever uses it looks at its time (`freshness.py`).

        Raises:
            SensorLost: nothing has arrived.
        """

    @abc.abstractmethod
    def look(self, camera: str) -> Frame:
        """Latest RGB-D frame of one of `CAMERAS`, with the time of its exposure.

        Raises:
            SensorLost: the camera is dead, or there is none of that name.
        """

    @abc.abstractmethod
    def send(self, command: Command) -> Command:
        """Start `command`, replacing what the same joints, hand or base were doing.

        Returns:
            The command as really sent after clipping to the limits: what the robot then does.

        Raises:
            EmergencyStop: it is pressed.
            WorldError: this robot cannot do that.
        """

    @abc.abstractmethod
    def stop(self) -> None:
        """End every motion now.  Grippers keep their opening.

        Safe to call at any time, twice too, right after a command, and from another thread.
        """

    def close(self) -> None:  # noqa: B027 most worlds hold nothing
        """Release what the world holds (processes, files, connections); twice is once."""

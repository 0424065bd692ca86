"""What the robot measures of itself, collected from its topics into one observation."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..world import SIDES, Observation, SensorLost
from .calibration import carried_on, load_at_hand, way_between
from .messages import message
from .ros import ros
from .site import Site

UNSTAMPED = 0.2  # [s] that the robot's state may have come before what is measured: three ticks
KEPT = 200  # samples of odometry, to find the one at the time of a pose in the map


@dataclass(frozen=True)
class Sample:
    """Something measured, at a time of the robot's [s]."""

    stamp: float
    value: Any


class Senses:
    """Listens to all but the cameras.

    Args:
        rospy: the node.
        site: names the topics, and holds the calibration.
        changed: is told of everything that is measured.

    Attributes:
        joints: positions, velocities, efforts (2, n) and the head's angle.
        measured: when the last joint state was measured that `on_joints` is done with [s].
        on_joints: called with every joint state, in the thread that receives it.
    """

    def __init__(self, rospy: Any, site: Site, changed: threading.Condition) -> None:
        there = ros()
        self._site, self._changed = site, changed
        self.joints: Sample | None = None
        self.measured = -np.inf
        self.on_joints: Callable[[Sample], None] = lambda sample: None
        self._names = [name for side in SIDES for name in site.arms[side].joints]
        self._zero = np.array([site.arms[side].zero for side in SIDES])
        self._fingers: dict[str, Sample] = {}
        self._wrenches: dict[str, Sample] = {}
        self._odometry: deque[Sample] = deque(maxlen=KEPT)
        self._place: tuple[np.ndarray, np.ndarray] | None = None  # a pose in the map, and odometry's at that time
        self._state: Sample | None = None

        def listen(topic: str, kind: Any, heard: Callable[..., None], *more: str) -> Any:
            return rospy.Subscriber(topic, kind, heard, more or None, queue_size=5, tcp_nodelay=True)

        self._listening = [
            listen(site.joint_states.topic, there.sensor_msgs.JointState, lambda m, *_: self._heard_joints(m)),
            listen(site.base.odometry, there.nav_msgs.Odometry, lambda m, *_: self._heard_odometry(m)),
            listen(site.base.pose, there.geometry_msgs.PoseWithCovarianceStamped, lambda m, *_: self._heard_pose(m)),
            listen(site.state.topic, message("baxter_core_msgs/AssemblyState"), lambda m, *_: self._heard_state(m)),
        ]
        self.now: Callable[[], float] = lambda: 0.0  # robot's time [s], for what has no stamp
        for side in SIDES:
            grip, wrist = site.grippers[side], site.wrists[side]
            self._listening.append(listen(grip.state, there.sensor_msgs.JointState, self._heard_fingers, side))
            self._listening.append(listen(wrist.topic, there.geometry_msgs.WrenchStamped, self._heard_wrench, side))

    def close(self) -> None:
        """Listen no more."""
        for each in self._listening:
            each.unregister()

    def missing(self) -> list[str]:
        """Topics on which nothing has come yet."""
        site = self._site
        silent = {
            site.joint_states.topic: self.joints is None,
            site.base.odometry: not self._odometry,
            site.base.pose: self._place is None and bool(self._odometry),
            site.state.topic: self._state is None,
        }
        silent |= {site.grippers[side].state: side not in self._fingers for side in SIDES}
        silent |= {site.wrists[side].topic: side not in self._wrenches for side in SIDES}
        return [topic for topic, is_silent in silent.items() if is_silent]

    @property
    def complete(self) -> float:
        """Until when everything is measured, and `on_joints` is done [s]; the state, which has no stamp, nearly so."""
        hands = [each[side] for each in (self._fingers, self._wrenches) for side in SIDES if side in each]
        if len(hands) < 2 * len(SIDES) or not self._odometry or self._state is None:
            return -np.inf
        state = self._state.stamp + UNSTAMPED  # as it counts in an observation, whose age is limited
        return min(self.measured, self._odometry[-1].stamp, state, *(each.stamp for each in hands))

    def stopped(self) -> str:
        """Why nothing may move, as the robot's state says it; empty where it may."""
        state = self._state.value if self._state is not None else None
        if state is None:
            return "nothing is known of the robot's state"
        if state.estop_button or state.stopped:
            return "the robot says that its emergency stop is pressed, or was and the robot is not enabled again"
        if state.error:
            return "the robot says that a part of it has an error"
        return "" if state.enabled else "the robot is not enabled"

    def base(self) -> tuple[np.ndarray, np.ndarray]:
        """Pose (3,) in the map [m, m, rad], and velocity in the base's own axes.

        Raises:
            SensorLost: nothing has come.
        """
        if self._place is None or not self._odometry:
            raise SensorLost(f"nothing has come on {self._site.base.odometry} and {self._site.base.pose}")
        (pose, at), (here, velocity) = self._place, self._odometry[-1].value
        return carried_on(pose, way_between(at, here)), velocity

    def observation(self, kinematics: Any) -> Observation:
        """All of it, as old as its oldest part; times are the robot's.

        Raises:
            SensorLost: of some of it nothing has come.
        """
        joints, state = self.joints, self._state
        if missing := self.missing():
            raise SensorLost(f"nothing has come on {', '.join(missing)}")
        assert joints is not None
        assert state is not None
        positions, velocities, efforts, head = joints.value
        pose, velocity = self.base()
        fingers = [self._fingers[side] for side in SIDES]
        wrenches = [self._wrenches[side] for side in SIDES]
        hands = np.array([kinematics.pose_hand_in_map(side, positions[n], pose) for n, side in enumerate(SIDES)])
        loads = [
            load_at_hand(wrenches[n].value, self._site.wrists[side], hands[n, :3, :3]) for n, side in enumerate(SIDES)
        ]
        stamps = [joints.stamp, state.stamp, self._odometry[-1].stamp, *(each.stamp for each in fingers + wrenches)]
        return Observation(
            time=min(stamps),
            arm_positions=positions.copy(),
            arm_velocities=velocities.copy(),
            arm_efforts=efforts.copy(),
            head_pan=head,
            pose_base_in_map=pose,
            twist_base=velocity.copy(),
            gripper_opening=np.array([max(each.value[0], 0.0) for each in fingers]),
            gripper_force=np.array([abs(each.value[1]) for each in fingers]),
            wrench_hand_in_map=np.array(loads),
            pose_hand_in_map=hands,
            emergency_stop=bool(self.stopped()),
        )

    # -- topics ------------------------------------------------------------------------------------------

    def _heard_joints(self, message: Any) -> None:
        where = {name: n for n, name in enumerate(message.name)}
        try:
            index = [where[name] for name in self._names]
            head = float(message.position[where[self._site.head.joint]])
        except KeyError:
            return  # other joints' states may come on the same topic
        take = [np.array(each, float)[index].reshape(2, -1) if each else None for each in _parts(message)]
        if take[0] is None:
            return
        zeros = np.zeros_like(take[0])
        positions = take[0] - self._zero
        velocities, efforts = (zeros if each is None else each for each in take[1:])
        sample = Sample(message.header.stamp.to_sec(), (positions, velocities, efforts, head))
        if self.joints is not None and sample.stamp <= self.joints.stamp:
            return
        self.joints = sample
        self.on_joints(sample)
        self.measured = sample.stamp
        self._tell()

    def _heard_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        velocity = np.array((twist.linear.x, twist.linear.y, twist.angular.z))
        self._odometry.append(Sample(message.header.stamp.to_sec(), (_planar(message.pose.pose), velocity)))
        self._tell()

    def _heard_pose(self, message: Any) -> None:
        known = list(self._odometry)
        if known:
            stamp = message.header.stamp.to_sec()
            nearest = min(known, key=lambda sample: abs(sample.stamp - stamp))
            self._place = _planar(message.pose.pose), nearest.value[0]

    def _heard_state(self, message: Any) -> None:
        if (now := self.now()) > 0.0:  # it has no stamp of its own, and may come before `/clock` has told the time
            self._state = Sample(now, message)

    def _heard_fingers(self, message: Any, more: Any) -> None:
        side = more[0]
        if (joint := self._site.grippers[side].joint) in message.name:
            n = list(message.name).index(joint)
            force = message.effort[n] if len(message.effort) > n else 0.0
            self._fingers[side] = Sample(message.header.stamp.to_sec(), (float(message.position[n]), float(force)))
            self._tell()

    def _heard_wrench(self, message: Any, more: Any) -> None:
        force, torque = message.wrench.force, message.wrench.torque
        measured = np.array((force.x, force.y, force.z, torque.x, torque.y, torque.z))
        self._wrenches[more[0]] = Sample(message.header.stamp.to_sec(), measured)
        self._tell()

    def _tell(self) -> None:
        with self._changed:
            self._changed.notify_all()


def _parts(message: Any) -> tuple[Any, Any, Any]:
    return message.position, message.velocity, message.effort


def _planar(pose: Any) -> np.ndarray:
    q = pose.orientation
    yaw = np.arctan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    return np.array((pose.position.x, pose.position.y, yaw))

"""What moves the robot: trajectories and fingers as actions, twists of the hands by a servo of our own, the base.

The servo steps with every joint state, so a robot that no longer measures is no longer driven: what takes velocities
holds still when none has come for a moment.
"""

from __future__ import annotations

import threading
import time as wall
from typing import Any

import numpy as np

from ..mechanics.kinematics import Kinematics
from ..mechanics.twist import TwistTracker
from ..robot.baxter import BAXTER
from ..robot.model import HEAD_JOINT, arm_joints
from ..world import SIDES, BaseVelocity, GripperOpening, HandTwist, JointTrajectory, SensorLost, Side, WorldError
from .action import ActionClient, Stamps
from .limits import Clipping
from .messages import message
from .ros import publisher, ros
from .senses import Sample, Senses
from .site import Site

SERVO = 0.0095  # [s] between two steps of the servo: 100 Hz, with some play
DRIVE = 0.045  # [s] between two velocities of the base
NEAR = 0.03  # [rad] from where a joint was sent last, it is held there rather than where it is
ON_ITS_WAY = 0.02  # [s] of wall time that a velocity may take to the robot
AFTER = 0.02  # [s] beyond the last step of the servo, the furthest that time may pass without one


class Motions:
    """Starts, carries on and ends motions.

    Args:
        rospy: the node.
        site: names the topics.
        senses: tell where the robot is.
        now: time as stamps have it [s].
        at_once: a message is on its way before anything else happens, as `publisher` has it.
    """

    def __init__(self, rospy: Any, site: Site, senses: Senses, now: Any, *, at_once: bool = False) -> None:
        there, kinematics = ros(), Kinematics(BAXTER)  # one of our own: the servo is another thread
        self._site, self._senses, self._now = site, senses, now
        self._lock = threading.RLock()
        self._clip = Clipping(kinematics, site)
        self._stamps = Stamps(now)

        def client(name: str, kind: str) -> ActionClient:
            return ActionClient(rospy, name, f"control_msgs/{kind}", self._stamps)

        self._arms = {side: client(site.arms[side].trajectory, "FollowJointTrajectory") for side in SIDES}
        self._grippers = {side: client(site.grippers[side].action, "GripperCommand") for side in SIDES}
        self._head = client(site.head.action, "SingleJointPosition")
        velocity = message("baxter_core_msgs/JointCommand")
        self._velocities = {
            side: publisher(rospy, site.arms[side].velocity, velocity, at_once=at_once) for side in SIDES
        }
        self._base = publisher(rospy, site.base.command, there.geometry_msgs.Twist, at_once=at_once)
        self._trackers: dict[Side, TwistTracker] = {side: TwistTracker(kinematics, side) for side in SIDES}
        self._twisting = {side: False for side in SIDES}
        self._targets: dict[Side, np.ndarray | None] = {side: None for side in SIDES}  # where arms were sent last
        self._stepped = {side: -np.inf for side in SIDES}
        self._published = {side: -np.inf for side in SIDES}  # the last velocity [s] of wall time
        self._driving: tuple[np.ndarray, float] | None = None
        self._drove = -np.inf
        senses.on_joints = self._step

    def missing(self) -> list[str]:
        """Topics and actions that nobody takes."""
        clients = [*self._arms.values(), *self._grippers.values(), self._head]
        gone = [each.name for each in clients if not each.connected()]
        topics = {self._site.base.command: self._base}
        topics |= {self._site.arms[side].velocity: self._velocities[side] for side in SIDES}
        return gone + [topic for topic, publisher in topics.items() if not publisher.get_num_connections()]

    def close(self) -> None:
        """Release the topics."""
        self._senses.on_joints = lambda sample: None
        for each in (*self._arms.values(), *self._grippers.values(), self._head):
            each.close()
        for each in (*self._velocities.values(), self._base):
            each.unregister()

    @property
    def servoing(self) -> bool:
        """Whether the servo has something to do."""
        return any(self._twisting.values()) or self._driving is not None

    def last_step(self) -> float:
        """Until when time may pass before the servo has to step again [s]."""
        return self._senses.measured + AFTER

    # -- commands ----------------------------------------------------------------------------------------

    def follow(self, command: JointTrajectory) -> JointTrajectory:
        """Start a trajectory; returns it as clipped.

        Raises:
            WorldError: the robot does not have one of the joints.
        """
        command.check_joints(BAXTER)
        sent, slopes = self._clip.trajectory(command)
        goals: list[tuple[ActionClient, Any]] = []
        for side in SIDES:  # a velocity on its way would end the trajectory
            if any(name in arm_joints(side) for name in sent.joints):
                wall.sleep(max(self._published[side] + ON_ITS_WAY - wall.monotonic(), 0.0))
        with self._lock:
            for side in SIDES:
                columns = [n for n, name in enumerate(sent.joints) if name in arm_joints(side)]
                if columns:
                    goals.append((self._arms[side], self._arm_goal(side, sent, slopes, columns)))
                    self._twisting[side] = False
                    self._trackers[side].cancel()
            if HEAD_JOINT in sent.joints:
                goals.append((self._head, self._head_goal(sent)))
            for client, goal in goals:
                client.send(goal)
        for client, goal in goals:
            client.wait_taken(goal)
        return sent

    def twist(self, command: HandTwist) -> HandTwist:
        """Move a hand with a velocity; returns it as clipped."""
        joints, side = self._senses.joints, command.side
        if joints is None:
            raise SensorLost(f"nothing has come on {self._site.joint_states.topic}")
        if not self._velocities[side].get_num_connections():
            raise WorldError(f"nobody takes velocities at {self._site.arms[side].velocity}")
        with self._lock:
            if not self._twisting[side]:
                self._arms[side].cancel()
            self._targets[side] = None
            self._twisting[side] = True
            return self._trackers[side].start(command, max(joints.stamp, self._stepped[side]))

    def drive(self, command: BaseVelocity) -> BaseVelocity:
        """Drive the base; returns the command as clipped."""
        sent = self._clip.base(command)
        if not self._base.get_num_connections():
            raise WorldError(f"nobody takes velocities at {self._site.base.command}")
        with self._lock:
            self._driving = np.asarray(sent.velocity), self._now() + sent.duration
            self._publish_base(self._driving[0])
        return sent

    def grip(self, command: GripperOpening) -> GripperOpening:
        """Move fingers; returns the command as clipped."""
        sent = self._clip.gripper(command)
        client = self._grippers[command.side]
        kind = message("control_msgs/GripperCommand")
        goal = client.goal(command=kind(position=sent.opening, max_effort=sent.force_limit))
        client.send(goal)
        client.wait_taken(goal)
        return sent

    def stop(self) -> None:
        """End every motion but the fingers'."""
        with self._lock:
            for each in (*self._arms.values(), self._head):
                each.cancel()
            for side in SIDES:
                self._trackers[side].cancel()
                if self._twisting[side]:
                    self._publish_velocities(side, np.zeros(len(self._site.arms[side].joints)))
                self._twisting[side], self._targets[side] = False, None
            self._driving = None
            self._publish_base(np.zeros(3))

    # -- messages ----------------------------------------------------------------------------------------

    def _arm_goal(self, side: Side, sent: JointTrajectory, slopes: np.ndarray, columns: list[int]) -> Any:
        """A goal for the whole arm: its controller takes no part of one, so the other joints are held."""
        there, arm = ros(), self._site.arms[side]
        if self._senses.joints is None:
            raise SensorLost(f"nothing has come on {self._site.joint_states.topic}")
        index = [arm_joints(side).index(sent.joints[n]) for n in columns]
        held = self._senses.joints.value[0][SIDES.index(side)].copy()
        last = self._targets[side]
        if last is not None:
            held = np.where(np.abs(last - held) < NEAR, last, held)
        positions = np.tile(held, (len(sent.times), 1))
        positions[:, index] = sent.positions[:, columns]
        speeds = np.zeros_like(positions)
        speeds[:, index] = slopes[:, columns]
        self._targets[side] = positions[-1]
        points = [
            there.trajectory_msgs.JointTrajectoryPoint(
                positions=(positions[k] + arm.zero).tolist(),
                velocities=speeds[k].tolist(),
                time_from_start=there.genpy.Duration(float(time)),
            )
            for k, time in enumerate(sent.times)
        ]
        path = there.trajectory_msgs.JointTrajectory(joint_names=list(arm.joints), points=points)
        return self._arms[side].goal(trajectory=path)

    def _head_goal(self, sent: JointTrajectory) -> Any:
        lasts, end = float(sent.times[-1]), float(sent.positions[-1, sent.joints.index(HEAD_JOINT)])
        return self._head.goal(
            position=end, min_duration=ros().genpy.Duration(lasts), max_velocity=self._site.head.speed
        )

    def _publish_velocities(self, side: Side, rates: np.ndarray) -> None:
        kind = message("baxter_core_msgs/JointCommand")
        names = list(self._site.arms[side].joints)
        self._published[side] = wall.monotonic()
        self._velocities[side].publish(kind(mode=kind.VELOCITY_MODE, command=rates.tolist(), names=names))

    def _publish_base(self, velocity: np.ndarray) -> None:
        twist = ros().geometry_msgs.Twist()
        twist.linear.x, twist.linear.y, twist.angular.z = (float(each) for each in velocity)
        self._base.publish(twist)
        self._drove = self._now()

    # -- the servo ---------------------------------------------------------------------------------------

    def _step(self, sample: Sample) -> None:
        """One step with every joint state."""
        with self._lock:
            for side in SIDES:
                if self._twisting[side] and sample.stamp - self._stepped[side] >= SERVO:
                    self._step_arm(side, sample)
            self._step_base()

    def _step_arm(self, side: Side, sample: Sample) -> None:
        n, (positions, velocities, *_) = SIDES.index(side), sample.value
        try:
            pose, velocity = self._senses.base()
        except SensorLost:
            return
        self._stepped[side] = sample.stamp
        rates = self._trackers[side].rates(sample.stamp, positions[n], velocities[n], pose, velocity)
        if rates is None:
            self._twisting[side] = False
            rates = np.zeros_like(positions[n])
        self._publish_velocities(side, rates)

    def _step_base(self) -> None:
        if self._driving is None:
            return
        velocity, until = self._driving
        if (now := self._now()) >= until:
            self._publish_base(np.zeros(3))
            self._driving = None
        elif now - self._drove >= DRIVE:
            self._publish_base(velocity)

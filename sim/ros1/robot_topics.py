"""What a simulated robot tells of itself, as the messages of a site."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mechanics.kinematics import Kinematics
from ..world import SIDES, Frame, Observation, SensorLost, World
from .calibration import felt_by_sensor, way_between
from .messages import message
from .ros import ros
from .site import Site

IMAGES_AGAIN = 5  # times the same time is told for each time that its images are
SLOWER = 2  # joint states for each message of the other senses
POSE_EVERY = 1.0  # [s] between two poses in the map


class RobotTopics:
    """Publishes the senses of a world.

    Args:
        rospy: the node.
        site: names the topics, and holds the calibration: what is measured here differs by it.
        kinematics: of the robot.
        camera_rate: of images [Hz].
    """

    def __init__(self, rospy: Any, site: Site, kinematics: Kinematics, camera_rate: float) -> None:
        there = ros()
        self._site, self._kinematics = site, kinematics
        self._camera_period = 1.0 / camera_rate
        self._count = 0

        def topic(name: str, kind: Any, **options: Any) -> Any:
            return rospy.Publisher(name, kind, queue_size=5, tcp_nodelay=True, **options)

        self._clock = topic("/clock", there.rosgraph_msgs.Clock)
        self._joints = topic(site.joint_states.topic, there.sensor_msgs.JointState)
        self._odometry = topic(site.base.odometry, there.nav_msgs.Odometry)
        self._pose = topic(site.base.pose, there.geometry_msgs.PoseWithCovarianceStamped, latch=True)
        self._state = topic(site.state.topic, message("baxter_core_msgs/AssemblyState"))
        self._fingers = {side: topic(site.grippers[side].state, there.sensor_msgs.JointState) for side in SIDES}
        self._wrenches = {side: topic(site.wrists[side].topic, there.geometry_msgs.WrenchStamped) for side in SIDES}
        image, info = there.sensor_msgs.Image, there.sensor_msgs.CameraInfo
        self._cameras = {
            name: (topic(camera.colour, image), topic(camera.depth, image), topic(camera.info, info))
            for name, camera in site.cameras.items()
        }
        self._repeated = 0  # how often the same time has been told again
        self.begin(0.0)

    def begin(self, start: float) -> None:
        """Tell of another world from now on, at whose beginning `/clock` says `start` [s]."""
        self._start, self._placed = start, -np.inf
        self._shown: dict[str, tuple[float, tuple[Any, Any, Any]]] = {}  # when [s], and what, of each camera
        self._first: np.ndarray | None = None  # where odometry begins, in the map

    def publish(self, world: World, pressed: bool, enabled: bool, *, everything: bool, again: bool) -> None:
        """Tell how the robot is now.

        Args:
            world: whose robot.
            pressed: the red button.
            enabled: the robot's motors.
            everything: not the joints alone.
            again: the time has been told before: whoever heard it takes no notice.
        """
        seen, now = world.observe(), world.clock.now()
        stamp = ros().genpy.Time.from_sec(self._start + now)
        self._count += not again
        if everything or self._count % SLOWER == 0:
            self._publish_base(seen, stamp, now, again)
            self._publish_hands(seen, stamp)
            kind = message("baxter_core_msgs/AssemblyState")
            self._state.publish(
                kind(
                    ready=enabled,
                    enabled=enabled,
                    stopped=pressed,
                    estop_button=kind.ESTOP_BUTTON_PRESSED if pressed else kind.ESTOP_BUTTON_UNPRESSED,
                    estop_source=kind.ESTOP_SOURCE_USER if pressed else kind.ESTOP_SOURCE_NONE,
                )
            )
        self._joints.publish(self._joint_state(seen, stamp))
        self._repeated = self._repeated + 1 if again else 0
        self._publish_images(world, now, again=self._repeated % IMAGES_AGAIN == 1)
        self._clock.publish(ros().rosgraph_msgs.Clock(clock=stamp))

    def _joint_state(self, seen: Observation, stamp: Any) -> Any:
        site, state = self._site, ros().sensor_msgs.JointState()
        state.header.stamp = stamp
        zeros = np.concatenate([site.arms[side].zero for side in SIDES])
        state.name = [*(name for side in SIDES for name in site.arms[side].joints), site.head.joint]
        state.position = [*(seen.arm_positions.ravel() + zeros).tolist(), float(seen.head_pan)]
        state.velocity = [*seen.arm_velocities.ravel().tolist(), 0.0]
        state.effort = [*seen.arm_efforts.ravel().tolist(), 0.0]
        return state

    def _publish_base(self, seen: Observation, stamp: Any, now: float, again: bool) -> None:
        there, site = ros(), self._site.base
        if self._first is None:
            self._first = np.array(seen.pose_base_in_map, float)
        odometry = there.nav_msgs.Odometry(child_frame_id="base_link")
        odometry.header.stamp, odometry.header.frame_id = stamp, site.odometry_frame
        _place(odometry.pose.pose, *way_between(self._first, seen.pose_base_in_map))
        twist = odometry.twist.twist
        twist.linear.x, twist.linear.y, twist.angular.z = (float(each) for each in seen.twist_base)
        self._odometry.publish(odometry)
        if again or now - self._placed >= POSE_EVERY - 1e-6:
            self._placed = now
            pose = there.geometry_msgs.PoseWithCovarianceStamped()
            pose.header.stamp, pose.header.frame_id = stamp, site.map_frame
            _place(pose.pose.pose, *seen.pose_base_in_map)
            self._pose.publish(pose)

    def _publish_hands(self, seen: Observation, stamp: Any) -> None:
        there = ros()
        for n, side in enumerate(SIDES):
            fingers = there.sensor_msgs.JointState(name=[self._site.grippers[side].joint])
            fingers.header.stamp = stamp
            fingers.position, fingers.effort = [float(seen.gripper_opening[n])], [float(seen.gripper_force[n])]
            self._fingers[side].publish(fingers)
            wrist = self._site.wrists[side]
            felt = there.geometry_msgs.WrenchStamped()
            felt.header.stamp, felt.header.frame_id = stamp, wrist.frame
            hand = self._kinematics.pose_hand_in_map(side, seen.arm_positions[n], seen.pose_base_in_map)
            measured = felt_by_sensor(seen.wrench_hand_in_map[n], wrist, hand[:3, :3])
            force, torque = felt.wrench.force, felt.wrench.torque
            force.x, force.y, force.z, torque.x, torque.y, torque.z = measured.tolist()
            self._wrenches[side].publish(felt)

    def _publish_images(self, world: World, now: float, *, again: bool) -> None:
        """Of the cameras that somebody looks through.

        While time stands still the same images go out again and again: who has just come cannot be told from who has
        just gone and come back, and what arrives before the joints is of no use to him.
        """
        for name, topics in self._cameras.items():
            if not all(each.get_num_connections() for each in topics):
                continue
            shown, images = self._shown.get(name, (-np.inf, ()))
            if now - shown >= self._camera_period - 1e-6:
                try:
                    frame = world.look(name)
                except SensorLost:
                    continue
                images = self._images(name, frame)
                self._shown[name] = now, images
            elif not again:
                continue
            colour, depth, info = topics
            for publisher, image in zip((info, colour, depth), images, strict=True):
                publisher.publish(image)

    def _images(self, name: str, frame: Frame) -> tuple[Any, Any, Any]:
        there, (height, width) = ros(), frame.depth.shape
        info = there.sensor_msgs.CameraInfo(height=height, width=width)
        fx, fy, cx, cy = frame.intrinsics
        info.K = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
        colour = there.sensor_msgs.Image(height=height, width=width, encoding="rgb8", step=3 * width)
        colour.data = np.ascontiguousarray(frame.rgb).tobytes()
        depth = there.sensor_msgs.Image(height=height, width=width, encoding="32FC1", step=4 * width)
        depth.data = np.ascontiguousarray(frame.depth, "<f4").tobytes()
        for each in (info, colour, depth):
            each.header.stamp = there.genpy.Time.from_sec(self._start + frame.stamp)
            each.header.frame_id = self._site.cameras[name].frame
        return info, colour, depth


def _place(pose: Any, x: float, y: float, yaw: float) -> None:
    pose.position.x, pose.position.y = float(x), float(y)
    pose.orientation.z, pose.orientation.w = float(np.sin(yaw / 2.0)), float(np.cos(yaw / 2.0))

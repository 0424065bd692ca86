"""Frames from topics: a colour image, the depth image of the same instant, and the intrinsics."""

from __future__ import annotations

import time as wall
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np

from ..world import Frame, SensorLost
from .ros import ros
from .senses import Sample
from .site import Camera, Site, transform

KEPT = 8  # images of each kind that wait for their fellow
TOGETHER = 0.02  # [s] between colour and depth of one frame
LATE = 5.0  # [s] of wall time that is waited for a frame where the robot's time waits too
LOOK = 0.002  # [s] between two looks whether it has come
# what a pose of the camera is made of: base pose (3,), arm joints (2, n), head [rad]
Posture = tuple[np.ndarray, np.ndarray, float]


class Cameras:
    """Listens to all cameras of a site.

    Args:
        rospy: the node.
        site: names the topics.
        posture: of the robot now.
        kinematics: places the cameras.
    """

    def __init__(self, rospy: Any, site: Site, posture: Callable[[], Posture], kinematics: Any) -> None:
        self._site, self._posture, self._kinematics = site, posture, kinematics
        self._eyes = {name: _Eye(rospy, camera, posture) for name, camera in site.cameras.items()}

    def close(self) -> None:
        """Listen no more."""
        for eye in self._eyes.values():
            eye.close()

    def look(self, camera: str) -> Frame:
        """The latest frame; its stamp is the robot's time.

        Raises:
            SensorLost: there is no such camera, or no whole frame has come.
        """
        if camera not in self._eyes:
            raise SensorLost(f"there is no camera {camera!r}; there are {', '.join(self._eyes) or 'none'}")
        eye = self._eyes[camera]
        if eye.frame is None or eye.info is None:
            wanted = self._site.cameras[camera]
            raise SensorLost(f"no frame has come on {wanted.colour}, {wanted.depth} and {wanted.info}")
        colour, depth, (base, arms, head) = eye.frame.value
        pose = self._kinematics.pose_camera_in_map(camera, base, arms, head)
        k = eye.info.K
        return Frame(
            camera=camera,
            stamp=eye.frame.stamp,
            rgb=pixels(colour),
            depth=metres(depth),
            intrinsics=(float(k[0]), float(k[4]), float(k[2]), float(k[5])),
            pose_camera_in_map=pose @ transform(self._site.cameras[camera].xyz, self._site.cameras[camera].rpy),
        )

    def wait(self, camera: str, stamp: float) -> None:
        """Wait for a frame of that time of the robot's [s] or later; for a moment only, as a camera may be dead."""
        ends, eye = wall.monotonic() + LATE, self._eyes.get(camera)
        while eye is not None and (eye.frame is None or eye.frame.stamp < stamp) and wall.monotonic() < ends:
            wall.sleep(LOOK)

    def missing(self) -> list[str]:
        """Cameras of which no whole frame has come."""
        return [name for name, eye in self._eyes.items() if eye.frame is None or eye.info is None]


class _Eye:
    """Puts colour and depth of one camera together as they come, with the posture in which they came."""

    def __init__(self, rospy: Any, camera: Camera, posture: Callable[[], Posture]) -> None:
        image, info = ros().sensor_msgs.Image, ros().sensor_msgs.CameraInfo
        self.frame: Sample | None = None
        self.info: Any = None
        self._posture = posture
        self._waiting: dict[str, OrderedDict[float, tuple[Any, Any]]] = {
            "colour": OrderedDict(),
            "depth": OrderedDict(),
        }
        options: dict[str, Any] = {"queue_size": 2, "buff_size": 2**24, "tcp_nodelay": True}
        self._listening = [
            rospy.Subscriber(camera.info, info, self._heard_info, **options),
            rospy.Subscriber(camera.colour, image, self._heard, "colour", **options),
            rospy.Subscriber(camera.depth, image, self._heard, "depth", **options),
        ]

    def close(self) -> None:
        for each in self._listening:
            each.unregister()

    def _heard_info(self, message: Any) -> None:
        self.info = message

    def _heard(self, message: Any, kind: str) -> None:
        try:
            posture = self._posture()
        except SensorLost:
            return
        stamp, other = message.header.stamp.to_sec(), "depth" if kind == "colour" else "colour"
        mine, waiting = self._waiting[kind], self._waiting[other]
        mine[stamp] = message, posture
        while len(mine) > KEPT:
            mine.popitem(last=False)
        fellow = min(list(waiting), key=lambda each: abs(each - stamp), default=None)
        if fellow is None or abs(fellow - stamp) > TOGETHER:
            return
        if self.frame is None or fellow > self.frame.stamp:
            images = {kind: message, other: waiting[fellow][0]}
            self.frame = Sample(min(stamp, fellow), (images["colour"], images["depth"], waiting[fellow][1]))


def pixels(image: Any) -> np.ndarray:
    """Colours (H, W, 3) uint8 of an image message.

    Raises:
        SensorLost: of an encoding that is no colour of 8 bits.
    """
    if image.encoding not in ("rgb8", "bgr8"):
        raise SensorLost(f"a colour image comes as {image.encoding}, but rgb8 or bgr8 is asked for")
    rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    found = rows[:, : 3 * image.width].reshape(image.height, image.width, 3)
    return np.ascontiguousarray(found if image.encoding == "rgb8" else found[:, :, ::-1])


def metres(image: Any) -> np.ndarray:
    """Depths (H, W) float32 of an image message [m], 0 where there is none.

    Raises:
        SensorLost: of an encoding that is no depth.
    """
    kinds = {"16UC1": (np.dtype("u2"), 0.001), "mono16": (np.dtype("u2"), 0.001), "32FC1": (np.dtype("f4"), 1.0)}
    if image.encoding not in kinds:
        raise SensorLost(f"a depth image comes as {image.encoding}, but 16UC1 or 32FC1 is asked for")
    kind, unit = kinds[image.encoding]
    rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    found = np.ascontiguousarray(rows[:, : kind.itemsize * image.width]).view(
        kind.newbyteorder(">" if image.is_bigendian else "<")
    )
    depth = found.astype(np.float32) * np.float32(unit)
    return np.where(np.isfinite(depth) & (depth > 0.0), depth, np.float32(0.0))

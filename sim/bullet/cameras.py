"""The robot's cameras in the simulated room."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..mechanics.kinematics import Kinematics
from ..render.camera import CAMERA_VIEWS, camera_intrinsics
from ..robot.body import JointReading
from ..sensors.sensor_errors import SensorErrors
from ..world import CAMERAS, Frame, SensorLost
from .backdrop import Backdrop


@dataclass(frozen=True, kw_only=True)
class Exposure:
    """All that an image shows, at one instant: enough to draw it later.

    Attributes:
        time: world clock [s].
        vertices: (V, 3) of the gown [m].
        arms: (2, 4, 3) of the person [m].
        reading: the robot's joints and base as they are.
        objects: name -> (V, 3) of what a task has added [m].
    """

    time: float
    vertices: np.ndarray
    arms: np.ndarray
    reading: JointReading
    objects: Mapping[str, np.ndarray] = field(default_factory=dict)


class Cameras:
    """Takes the frames that `World.look` gives.

    Args:
        expose: gives what there is to see now.
        backdrop: draws it.
        kinematics: of the robot, which puts the cameras where they are and where it takes them to be.
        errors: of the sensors.
        noise: of the images.

    Attributes:
        last: by camera, the image that was looked at last.
    """

    def __init__(
        self,
        expose: Callable[[], Exposure],
        backdrop: Backdrop,
        kinematics: Kinematics,
        errors: SensorErrors,
        noise: np.random.Generator,
    ) -> None:
        self._expose, self._backdrop, self._kinematics = expose, backdrop, kinematics
        self._errors, self._noise = errors, noise
        self.last: dict[str, Frame] = {}

    def pass_time(self, time: float) -> None:
        """Keep what there is to see at `time` [s], if images of it will be delivered later."""
        if self._errors.late and self._errors.late.due(time):
            self._errors.late.keep(self._expose())

    def look(self, camera: str, time: float) -> Frame:
        """The image that arrived last at `time` [s], drawn only now.

        Raises:
            SensorLost: there is no such camera.
        """
        if camera not in CAMERAS:
            raise SensorLost(f"there is no camera '{camera}'; there are {', '.join(CAMERAS)}")
        late = self._errors.late
        seen: Exposure = (late and late.newest(camera, time)) or self._expose()
        reading = seen.reading
        configuration = self._kinematics.configuration(
            reading.pose_base_in_map, reading.arm_positions, reading.head_pan, reading.gripper_opening
        )
        renderer = self._backdrop.update(seen.vertices, seen.arms, configuration, seen.objects)
        pose = self._errors.pose_camera(camera, self._pose(camera, reading))
        rgb, depth = renderer.photograph(camera, pose, self._noise)
        assert rgb.shape[:2] == CAMERA_VIEWS[camera][0][::-1]
        self.last[camera] = Frame(
            camera=camera,
            stamp=seen.time,
            rgb=rgb,
            depth=self._errors.depth(depth),
            intrinsics=camera_intrinsics(camera),
            pose_camera_in_map=self._pose(camera, self._errors.joints(reading, seen.time)),
        )
        return self.last[camera]

    def _pose(self, camera: str, reading: JointReading) -> np.ndarray:
        return self._kinematics.pose_camera_in_map(
            camera, reading.pose_base_in_map, reading.arm_positions, reading.head_pan
        )

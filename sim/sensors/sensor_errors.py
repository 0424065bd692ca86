"""All that lies between the truth and what the robot senses of it, for one run."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..robot.model import COMMANDED_JOINTS
from ..scene.difficulties import SIZES, Sizes, stream
from ..world import Command, HandTwist, JointTrajectory
from ..world_kind import WorldKind
from .camera_extrinsics import camera_errors
from .depth_noise import disturbed_depth
from .encoders import Encoders
from .late_images import LateImages
from .late_wrenches import LateWrenches
from .localisation import Localisation
from .sensor_changes import SensorChanges
from .wrist_sensors import WristSensors

if TYPE_CHECKING:
    from ..robot.body import JointReading

HEAD = "head"  # the camera that a model file may move


class SensorErrors:
    """The errors that a kind of world has; everything passes through unchanged where it has none.

    Args:
        seed: of the run; each difficulty draws from a stream of its own.
        kind: of the world.
        sizes: of the difficulties.
        changes: what a model file adds, or None.
        joints: of two arms and the head, as trajectories name them; Baxter's by default.

    Attributes:
        late: what there was to see before, in a world whose images are late.
    """

    def __init__(
        self,
        seed: int,
        kind: WorldKind,
        sizes: Sizes = SIZES,
        changes: SensorChanges | None = None,
        joints: tuple[str, ...] = COMMANDED_JOINTS,
    ) -> None:
        def drawn(difficulty: str) -> np.random.Generator | None:
            return stream(seed, difficulty) if kind.has(difficulty) else None

        self._encoders = Encoders(rng, sizes.encoders, joints) if (rng := drawn("encoders")) else None
        self._localisation = Localisation(rng, sizes.localisation) if (rng := drawn("localisation")) else None
        self._cameras = camera_errors(rng, sizes.camera_extrinsics) if (rng := drawn("camera_extrinsics")) else {}
        rng = drawn("late_images")
        self.late: LateImages[Any] | None = LateImages(rng, sizes.late_images) if rng else None
        self._depth_noise, self._depth_sizes = drawn("depth_noise"), sizes.depth_noise
        self._wrists = WristSensors.drawn(rng, sizes.wrench_bias) if (rng := drawn("wrench_bias")) else None
        if self._wrists is None and (self._encoders or self._localisation):
            self._wrists = WristSensors()  # the orientation that they are told is off
        changes = changes or SensorChanges()
        if changes.bias.any():
            wrists = self._wrists or WristSensors()
            self._wrists = replace(wrists, bias=wrists.bias + np.pad(changes.bias, ((0, 0), (0, 3))))
        self._late_wrenches = LateWrenches(changes.delay) if changes.delay else None
        if changes.camera.any():
            moved = np.eye(4)
            moved[:3, 3] = changes.camera
            self._cameras = {**self._cameras, HEAD: self._cameras.get(HEAD, np.eye(4)) @ moved}

    def joints(self, reading: JointReading, time: float) -> JointReading:
        """What the robot reads at `time` [s] of joints and base that stand as in `reading`."""
        if self._encoders:
            reading = self._encoders.measured(reading)
        if self._localisation:
            reading = replace(reading, pose_base_in_map=self._localisation.measured(reading.pose_base_in_map, time))
        return reading

    def wrench(
        self, wrench_in_map: np.ndarray, poses: np.ndarray, measured_poses: np.ndarray, time: float
    ) -> np.ndarray:
        """(2, 6) load on the hands as reported at `time` [s]; see `WristSensors.measured`."""
        if self._late_wrenches:
            wrench_in_map = self._late_wrenches.measured(wrench_in_map, time)
        return self._wrists.measured(wrench_in_map, poses, measured_poses) if self._wrists else wrench_in_map

    def pose_camera(self, camera: str, pose_taken: np.ndarray) -> np.ndarray:
        """(4, 4) where a camera is that ought to be at `pose_taken` (4, 4)."""
        return pose_taken @ self._cameras[camera] if camera in self._cameras else pose_taken

    def depth(self, depth: np.ndarray) -> np.ndarray:
        """(H, W) float32 depth as delivered, 0 where there is none [m]."""
        if self._depth_noise is None:
            return depth
        return disturbed_depth(depth, self._depth_noise, self._depth_sizes)

    def executed(self, command: Command, time: float) -> Command:
        """What a command that is given in the robot's own readings really asks of joints and hands."""
        if self._encoders and isinstance(command, JointTrajectory):
            return self._encoders.angles(command)
        if self._localisation and isinstance(command, HandTwist):
            return self._localisation.executed(command, time)
        return command

    def told(self, command: Command, time: float) -> Command:
        """The way back: what is really done, as the robot reads it."""
        if self._encoders and isinstance(command, JointTrajectory):
            return self._encoders.readings(command)
        if self._localisation and isinstance(command, HandTwist):
            return self._localisation.told(command, time)
        return command

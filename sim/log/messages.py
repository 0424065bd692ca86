"""What the world's contract speaks of, as messages of a log: topic, name of the schema, content."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np

from ..mechanics.robot_model import RobotModel
from ..world import SIDES, Command, Frame, Observation

Message = tuple[str, str, dict[str, Any] | str]  # topic, schema, content; text is JSON already
TIME_SLOT = '{"sec":%d,"nsec":%d}'
DIGITS = 9  # of a number behind the point: far below any sensor's noise
JPEG_QUALITY = 88
ROBOT = "robot.json"  # name of the attachment that says which joint is what
MILLIMETRES = 1000.0  # of depth in a picture of whole numbers, as ROS has it


def roles(robot: RobotModel) -> str:
    """Which of a robot's joints is what, as JSON."""
    return json.dumps(
        {
            "name": robot.name,
            "arms": {side: robot.joints_of(side) for side in SIDES},
            "fingers": {side: robot.fingers[side] for side in SIDES},
            "head": robot.head_joint,
            "base": robot.base_joints,
        }
    )


def stamp(time: float) -> dict[str, int]:
    """A time [s] as Foxglove writes it."""
    nanoseconds = round(time * 1e9)
    return {"sec": nanoseconds // 10**9, "nsec": nanoseconds % 10**9}


class Observed:
    """Writes what one robot measures of itself.

    The base's joints and the fingers stand among the joints, as the robot's URDF has them: joints and URDF tell where
    every link is.  Every tick has an observation, so the text is made ready once and filled in.

    Args:
        robot: whose joints these are.
    """

    def __init__(self, robot: RobotModel) -> None:
        arms = [name for side in SIDES for name in robot.joints_of(side)]
        fingers = [name for side in SIDES for name in robot.fingers[side]]
        placed = [robot.head_joint, *robot.base_joints]
        joints = [_slots({"name": name, "position": 0, "velocity": 0, "effort": 0}) for name in arms]
        joints += [_slots({"name": name, "position": 0, "effort": 0}) for name in fingers]
        joints += [_slots({"name": name, "position": 0}) for name in placed]
        self._joints = _Text(f'{{"timestamp":{TIME_SLOT},"joints":[{",".join(joints)}]}}')
        wrench = {"force": dict.fromkeys("xyz", 0), "torque": dict.fromkeys("xyz", 0)}
        planar = dict.fromkeys(("x", "y", "yaw"), 0)
        rest = _slots({"base_in_map": planar, "twist_in_base": planar, **{f"{side}_hand": wrench for side in SIDES}})
        self._rest = {
            pressed: _Text(f'{{"timestamp":{TIME_SLOT},"emergency_stop":{json.dumps(pressed)},{rest[1:]}')
            for pressed in (False, True)
        }

    def messages(self, seen: Observation) -> Iterator[Message]:
        """The joints, and the rest: base, load on the hands, emergency stop."""
        arms = np.array((seen.arm_positions, seen.arm_velocities, seen.arm_efforts)).reshape(3, -1)
        fingers = np.array((seen.gripper_opening / 2.0, seen.gripper_force)).repeat(2, axis=1)
        parts = (arms.T.ravel(), fingers.T.ravel(), (seen.head_pan,), seen.pose_base_in_map)
        yield "/joint_states", "foxglove.JointStates", self._joints.of(seen.time, np.concatenate(parts))
        rest = np.concatenate((seen.pose_base_in_map, seen.twist_base, seen.wrench_hand_in_map.ravel()))
        yield "/measured", "caretree.Measured", self._rest[bool(seen.emergency_stop)].of(seen.time, rest)


class _Text:
    """JSON with slots for numbers, which it knows none of that is not finite: that is null."""

    def __init__(self, text: str) -> None:
        self._finite, self._any = text.replace("%s", "%.10g"), text

    def of(self, time: float, numbers: np.ndarray) -> str:
        """It with a time [s] and numbers (n,)."""
        nanoseconds, values = round(time * 1e9), numbers.tolist()
        at = (nanoseconds // 10**9, nanoseconds % 10**9)
        if math.isfinite(sum(values)):
            return self._finite % (*at, *values)
        return self._any % (*at, *(f"{value:.10g}" if math.isfinite(value) else "null" for value in values))


def looked(frame: Frame) -> Iterator[Message]:
    """A picture, its depth [mm], and where it was taken with what lens.

    Colour is JPEG where OpenCV is there, and as it is where it is not.
    """
    time, name = stamp(frame.stamp), f"{frame.camera}_camera"
    of_camera = {"timestamp": time, "frame_id": name}
    height, width = frame.depth.shape
    fx, fy, cx, cy = (float(value) for value in frame.intrinsics)
    yield (
        f"/{name}/calibration",
        "foxglove.CameraCalibration",
        {
            **of_camera,
            "width": width,
            "height": height,
            "distortion_model": "plumb_bob",
            "D": [0.0] * 5,
            "K": [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            "R": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            "P": [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        },
    )
    pose = frame.pose_camera_in_map
    taken_from = [_transform(time, name, pose[:3, 3], quaternion(pose[:3, :3]))]
    yield "/tf", "foxglove.FrameTransforms", {"transforms": taken_from}
    try:
        import cv2
    except ModuleNotFoundError:
        yield f"/{name}/image", "foxglove.RawImage", {**of_camera, **_raw(frame.rgb, "rgb8")}
    else:
        _, jpeg = cv2.imencode(".jpg", frame.rgb[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
        image = {**of_camera, "format": "jpeg", "data": base64.b64encode(jpeg.tobytes()).decode()}
        yield f"/{name}/image", "foxglove.CompressedImage", image
    depth = np.clip(np.nan_to_num(frame.depth) * MILLIMETRES, 0.0, np.iinfo(np.uint16).max).astype("<u2")
    yield f"/{name}/depth", "foxglove.RawImage", {**of_camera, **_raw(depth, "16UC1")}


def sent(time: float, command: Command) -> Message:
    """A command as it was really sent, at a time [s]; its fields have the names of the contract."""
    values = {each.name: getattr(command, each.name) for each in fields(command)}
    plain = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()}
    return "/sent", "caretree.Sent", {"timestamp": stamp(time), "command": type(command).__name__, **plain}


def stopped(time: float) -> Message:
    """A stop, at a time [s]."""
    return "/sent", "caretree.Sent", {"timestamp": stamp(time), "command": "stop"}


def quaternion(rotation: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) as x, y, z, w (4,), w at least 0: Shepperd's way, from the greatest of the four."""
    r = np.asarray(rotation, float)
    squares = np.array((r[0, 0], r[1, 1], r[2, 2], np.trace(r)))
    k = int(np.argmax(squares))
    q = np.empty(4)
    if k == 3:
        q[:3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
        q[3] = 1.0 + squares[3]
    else:
        i, j = (k + 1) % 3, (k + 2) % 3
        q[k], q[i], q[j] = 1.0 + 2.0 * squares[k] - squares[3], r[i, k] + r[k, i], r[j, k] + r[k, j]
        q[3] = r[j, i] - r[i, j]
    return q / np.linalg.norm(q) * (1.0 if q[3] >= 0.0 else -1.0)


def _transform(time: dict[str, int], child: str, place: np.ndarray, turn: np.ndarray) -> dict[str, Any]:
    return {
        "timestamp": time,
        "parent_frame_id": "map",
        "child_frame_id": child,
        "translation": _named("x y z", np.round(place, DIGITS).tolist()),
        "rotation": _named("x y z w", np.round(turn, DIGITS).tolist()),
    }


def _named(names: str, values: list[float]) -> dict[str, float]:
    return dict(zip(names.split(), values, strict=True))


def _slots(content: dict[str, Any]) -> str:
    """Content as JSON, with a slot for text in the place of every 0."""
    return json.dumps(content, separators=(",", ":")).replace(":0", ":%s")


def _raw(picture: np.ndarray, encoding: str) -> dict[str, Any]:
    height, width = picture.shape[:2]
    data = np.ascontiguousarray(picture)
    return {
        "width": width,
        "height": height,
        "encoding": encoding,
        "step": data.nbytes // height,
        "data": base64.b64encode(data.tobytes()).decode(),
    }

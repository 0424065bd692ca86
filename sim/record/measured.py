"""What the robot itself measured in a run, as an array file: its hands and their loads, and the arms as it saw them.

Everything that a real robot has too, and nothing of the truth: `caretree gap` compares it with a model of the room.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..world import SIDES, Observation, Side
from .record import MEASURED_FILE
from .spool import disk_error
from .stored_arrays import stored_arrays


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """One run, as its robot measured it.

    Attributes:
        t: (T,) world clock of each sample [s].
        pose_hand: (T, 2, 7) position [m] and quaternion x, y, z, w of each hand in the map, by forward kinematics.
        wrench_hand: (T, 2, 6) load on each hand along the map's axes [N], [N m].
        gripper_opening: (T, 2) distance between the fingertips [m].
        arm_positions: (T, 2, n) joint angles of the robot's arms [rad].
        head_pan: (T,) angle of its head [rad].
        pose_base: (T, 3) x, y, yaw of its base in the map [m, m, rad].
        arm_t: (N,) when an arm of the person was seen [s].
        arm_side: (N,) which one: 0 left, 1 right.
        arm_points: (N, 4, 3) shoulder, elbow, wrist, fingertip as tracked [m].
    """

    t: np.ndarray
    pose_hand: np.ndarray
    wrench_hand: np.ndarray
    gripper_opening: np.ndarray
    arm_positions: np.ndarray
    head_pan: np.ndarray
    pose_base: np.ndarray
    arm_t: np.ndarray
    arm_side: np.ndarray
    arm_points: np.ndarray


class MeasuredLog:
    """Collects what is measured, and writes it at the end of the run."""

    def __init__(self) -> None:
        self._rows: list[Observation] = []
        self._arms: list[tuple[float, int, np.ndarray]] = []

    def sample(self, seen: Observation) -> None:
        """Keep one observation."""
        self._rows.append(seen)

    def arm(self, time: float, side: Side, points_in_map: np.ndarray) -> None:
        """Keep one look at an arm of the person: (4, 3) points [m]."""
        self._arms.append((time, SIDES.index(side), np.array(points_in_map, float)))

    def write(self, directory: Path) -> None:
        """Write the file; none where nothing was measured.

        Raises:
            RecordError: the disk is full, or the samples differ in shape.
        """
        if not self._rows:
            return
        arms = self._arms
        path = directory / MEASURED_FILE
        part = path.with_name(path.name + ".part")
        try:
            poses = np.array([seen.pose_hand_in_map for seen in self._rows])
            turns = _quaternions(poses[..., :3, :3])
            with part.open("wb") as file:
                np.savez_compressed(
                    file,
                    t=np.array([seen.time for seen in self._rows]),
                    pose_hand=np.concatenate([poses[..., :3, 3], turns], axis=2),
                    wrench_hand=np.array([seen.wrench_hand_in_map for seen in self._rows]),
                    gripper_opening=np.array([seen.gripper_opening for seen in self._rows]),
                    arm_positions=np.array([seen.arm_positions for seen in self._rows]),
                    head_pan=np.array([seen.head_pan for seen in self._rows]),
                    pose_base=np.array([seen.pose_base_in_map for seen in self._rows]),
                    arm_t=np.array([a[0] for a in arms]),
                    arm_side=np.array([a[1] for a in arms], int),
                    arm_points=np.array([a[2] for a in arms]).reshape(-1, 4, 3),
                )
            part.replace(path)
        except OSError as error:
            part.unlink(missing_ok=True)
            raise disk_error(error, f"writing {path}") from error
        except ValueError as error:  # arrays that do not fit together
            part.unlink(missing_ok=True)
            raise RecordError(f"{path} cannot be written: {error}") from error


def _quaternions(turns: np.ndarray) -> np.ndarray:
    """(..., 4) quaternions x, y, z, w of rotations (..., 3, 3), exact for half turns too; the core has no scipy.

    Each is the eigenvector of the greatest eigenvalue of a symmetric matrix (Bar-Itzhack, 2000).
    """
    (a, b, c), (d, e, f), (g, h, k) = np.moveaxis(turns, (-2, -1), (0, 1))
    rows = ((a - e - k, b + d, c + g, h - f), (b + d, e - a - k, f + h, c - g), (c + g, f + h, k - a - e, d - b))
    rows = (*rows, (h - f, c - g, d - b, a + e + k))
    return np.linalg.eigh(np.stack([np.stack(row, axis=-1) for row in rows], axis=-2))[1][..., :, -1]


def read_measured(directory: Path) -> Measured:
    """What the robot measured in a recorded run.

    Raises:
        RecordError: the record has no such file, or it is damaged.
    """
    path = directory / MEASURED_FILE
    missing = ": the run was cut short, or is older than that file"
    found = Measured(**stored_arrays(path, Measured.__dataclass_fields__, missing))
    rows, looks = len(found.t), len(found.arm_t)
    joints = found.arm_positions.shape[-1:]
    asked = ((rows,), (rows, 2, 7), (rows, 2, 6), (rows, 2), (rows, 2, *joints), (rows,), (rows, 3))
    asked = (*asked, (looks,), (looks,), (looks, 4, 3))
    for name, shape in zip(Measured.__dataclass_fields__, asked, strict=True):
        if getattr(found, name).shape != shape:
            raise RecordError(f"{path} is damaged: {name} has shape {getattr(found, name).shape}, not {shape}")
    numbers = (found.t, found.arm_positions, found.head_pan, found.pose_base, found.gripper_opening, found.wrench_hand)
    if rows < 2 or not (np.diff(found.t) > 0).all() or not all(np.isfinite(x).all() for x in numbers):
        raise RecordError(f"{path} is damaged: its times do not grow, or a number is not finite")
    return found

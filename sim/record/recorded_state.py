"""One instant of a recorded run, from which another run can begin."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import RecordError
from .record import SPOOL_FOLDER, TRUTH_FILE
from .recorder import FRAME_PERIOD
from .spool import open_spool
from .stored_arrays import stored_arrays

NEEDED = ("t", "vertices", "arms", "gripper_closed", "holds_arm", "robot_capsules")


@dataclass(frozen=True, kw_only=True, eq=False)
class RecordedState:
    """Where everything was while the robot held nothing.

    Attributes:
        t: of the recorded clock [s].
        vertices: (V, 3) of the gown in the map frame [m].
        arms: (2, 4, 3) left and right shoulder, elbow, wrist, fingertip in the map frame [m].
        robot: (2,) about where the robot stood in the map frame: the mean of its links [m].
    """

    t: float
    vertices: np.ndarray
    arms: np.ndarray
    robot: np.ndarray


def recorded_state(directory: Path, time: float) -> RecordedState:
    """The frame of a record, finished or not, that is nearest to a time.

    Args:
        directory: of the record.
        time: of its clock [s].

    Raises:
        RecordError: the record is missing or damaged, does not reach to that time, or a hand holds something then.
    """
    frames = _frames(directory)
    t = np.asarray(frames["t"], float)
    if not t[0] <= time <= t[-1] + FRAME_PERIOD:  # the last event, whose time the log shows, is after the last frame
        raise RecordError(f"{directory} lasts from {t[0]:g} to {t[-1]:g} s, but {time:g} s is asked for")
    holding = np.any(frames["gripper_closed"], axis=1) | np.any(np.asarray(frames["holds_arm"]) >= 0, axis=1)
    free = np.logical_not(holding)
    n = int(np.abs(t - time).argmin())
    if not free[n]:
        empty = t[free]
        near = f"; they are empty at {empty[np.abs(empty - time).argmin()]:.2f} s" if len(empty) else ""
        raise RecordError(f"a run begins with empty hands, but at {time:g} s they hold something{near}")
    return RecordedState(
        t=float(t[n]),
        vertices=np.array(frames["vertices"][n], float),
        arms=np.array(frames["arms"][n], float),
        robot=np.array(frames["robot_capsules"][n], float)[:, [0, 1, 3, 4]].reshape(-1, 2).mean(axis=0),
    )


def _frames(directory: Path) -> dict[str, np.ndarray]:
    """The arrays that are needed, of a finished record or of one that was cut short."""
    path = directory / TRUTH_FILE
    if not path.exists() and (directory / SPOOL_FOLDER).exists():
        _static, rows = open_spool(directory / SPOOL_FOLDER)
        return {name: rows[name] for name in NEEDED}
    return stored_arrays(path, NEEDED, ", so nothing can begin there")

"""Joint states of a UR10 and a Panda in rosbag2 files; one run each, cut in time into fitted and held out."""

from __future__ import annotations

import sqlite3
import struct
from pathlib import Path

import numpy as np

from .setting import write_set

FIT = 0.6  # part of the run that may be fitted to; the rest is held out (optimistic: it is the same run)


def joint_states(path: Path) -> dict[str, np.ndarray]:
    """T (T,) and q, dq, tau (T, n) of every sensor_msgs/JointState in a rosbag2 sqlite file."""
    with sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True) as base:
        rows = base.execute("select data from messages order by timestamp").fetchall()
    parsed = [_joint_state(row[0]) for row in rows]
    return {
        "t": np.array([p[0] for p in parsed]),
        **{k: np.array([p[i + 1] for p in parsed]) for i, k in enumerate(("q", "dq", "tau"))},
    }


def _joint_state(data: bytes) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """One message in CDR, the plain little-endian encoding of ROS 2: values aligned to their size after 4 bytes."""
    at = 4

    def integer() -> int:
        nonlocal at
        at = 4 + -(-(at - 4) // 4) * 4
        value = struct.unpack_from("<I", data, at)[0]
        at += 4
        return value

    def text() -> None:
        nonlocal at
        size = integer()  # the size moves `at` first
        at += size

    def numbers() -> np.ndarray:
        nonlocal at
        n = integer()
        if n:
            at = 4 + -(-(at - 4) // 8) * 8
        values = np.frombuffer(data, "<f8", n, at)
        at += 8 * n
        return values

    seconds, nanoseconds = integer(), integer()
    text()
    for _ in range(integer()):
        text()
    return seconds + 1e-9 * nanoseconds, numbers(), numbers(), numbers()


def _write(path: Path, robot: str, out: Path) -> list[Path]:
    d = joint_states(path)
    cut, n = int(FIT * len(d["t"])), d["q"].shape[1]
    keep = np.concatenate([[True], np.diff(d["t"]) > 0])
    episodes = []
    for name, role, rows in (("first", "fit", slice(0, cut)), ("second", "heldout", slice(cut, None))):
        k = keep[rows]
        columns = {"t": d["t"][rows][k]}
        for short in ("q", "dq", "tau"):
            columns |= {f"{short}{j + 1}": d[short][rows][k][:, j] for j in range(n)}
        episodes.append((name, role, columns))
    return [write_set(out, {"system": "arm", "robot": robot}, episodes)]


def write_ur10(files: dict[str, Path], out: Path) -> list[Path]:
    """The UR10's exciting trajectory."""
    return _write(files["ur10_exciting_trajectory.db3"], "ur10", out)


def write_panda(files: dict[str, Path], out: Path) -> list[Path]:
    """The Panda's exciting trajectory; its URDF carries a hand the robot did not."""
    return _write(files["panda_exciting_trajectory.db3"], "panda", out)

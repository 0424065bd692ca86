"""Joint states of a UR10 and a Panda in rosbag2 files; one run each, cut in time into fitted and held out."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np

from .joint_state import from_cdr
from .setting import write_set

FIT = 0.6  # part of the run that may be fitted to; the rest is held out (optimistic: it is the same run)


def joint_states(path: Path) -> dict[str, np.ndarray]:
    """T (T,) and q, dq, tau (T, n) of every sensor_msgs/JointState in a rosbag2 sqlite file."""
    with sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True) as base:
        rows = base.execute("select data from messages order by timestamp").fetchall()
    parsed = [from_cdr(row[0]) for row in rows]
    parts = {"q": "position", "dq": "velocity", "tau": "effort"}
    return {
        "t": np.array([state.t for state in parsed]),
        **{k: np.array([list(getattr(state, part).values()) for state in parsed]) for k, part in parts.items()},
    }


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

"""An SO-101 arm at 50 Hz.  Its torque is an unsigned current estimate, so only sizes of loads can be compared."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np

from .setting import write_set

JOINTS = 5  # the sixth is the gripper


def write(files: dict[str, Path], out: Path) -> list[Path]:
    """One set from one motion, cut in time; the sign of each torque is taken from the velocity where there is one."""
    with files["static_holding/state_motor.csv"].open(newline="") as file:
        rows = [r for r in csv.DictReader(file)]
    t = np.array([float(r["timestamp"]) for r in rows]) * 1e-6
    q, dq, tau = (
        np.array([json.loads(r[k]) for r in rows])[:, :JOINTS] for k in ("positions", "velocities", "torques")
    )
    keep = np.concatenate([[True], np.diff(t) > 0])
    t, q, dq, tau = t[keep], q[keep], dq[keep], tau[keep]
    cut = int(0.6 * len(t))
    episodes = []
    for name, role, s in (("first", "fit", slice(0, cut)), ("second", "heldout", slice(cut, None))):
        columns = {"t": t[s]}
        for short, x in (("q", q), ("dq", dq), ("tau", tau)):
            columns |= {f"{short}{j + 1}": x[s, j] for j in range(JOINTS)}
        episodes.append((name, role, columns))
    return [write_set(out, {"system": "arm", "robot": "so101"}, episodes)]

"""A quasi-direct-drive double pendulum at about 285 Hz: two runs, with the authors' URDF."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np

from .setting import write_set


def write(files: dict[str, Path], out: Path) -> list[Path]:
    """One set: the first run to fit, the second held out."""
    episodes = []
    out.mkdir(parents=True, exist_ok=True)
    runs = [p for k, p in sorted(files.items()) if k.endswith(".csv")]
    for path, role in zip(runs, ("fit", "heldout"), strict=True):
        with path.open(newline="") as file:
            header, *rows = list(csv.reader(file))
        data = {k: np.array([float(r[i]) for r in rows]) for i, k in enumerate(header)}
        moved = np.concatenate([[True], np.diff(data["time"]) > 0])
        episodes.append(
            (
                path.stem,
                role,
                {
                    "t": data["time"][moved],
                    **{f"q{j}": data[f"pos_meas{j}"][moved] for j in (1, 2)},
                    **{f"dq{j}": data[f"vel_meas{j}"][moved] for j in (1, 2)},
                    **{f"tau{j}": data[f"tau_meas{j}"][moved] for j in (1, 2)},
                },
            )
        )
    urdf = next(p for k, p in files.items() if k.endswith(".urdf"))
    text = urdf.read_text()
    if '<link name="world"' not in text:  # the published file welds its base to a link it does not declare
        text = re.sub(r"(<robot[^>]*>)", r'\1\n  <link name="world"/>', text, count=1)
    (out / "pendulum.urdf").write_text(text)
    return [write_set(out, {"system": "arm", "robot": "pendulum.urdf"}, episodes)]

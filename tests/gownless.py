"""Records of tasks that have taken the gown out of the room."""

from pathlib import Path

import numpy as np
from caretree.sim.record.record import TRUTH_FILE


def without_gown(directory: Path) -> Path:
    """The record in `directory`, with nothing in it of a gown."""
    with np.load(directory / TRUTH_FILE) as stored:
        arrays = {name: stored[name] for name in stored.files}
    frames = len(arrays["t"])
    arrays |= {"vertices": np.zeros((frames, 0, 3)), "rest_vertices": np.zeros((0, 3)), "faces": np.zeros((0, 3), int)}
    arrays |= {name: np.zeros(0, int) for name in arrays if name.startswith("loop_") or name == "neckline"}
    np.savez(directory / TRUTH_FILE, **arrays)
    return directory

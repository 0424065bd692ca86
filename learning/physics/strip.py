"""Strips of clips: frames side by side, one clip a row."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np


def write_strip(path: str | Path, rows: Sequence[tuple[str, np.ndarray]], every: int = 2) -> Path:
    """Draw clips under each other.

    Args:
        path: picture to write.
        rows: (title, depth (frames, H, W) [m]).
        every: which frames: 0, every, 2 every, ...
    """
    from matplotlib.figure import Figure

    columns = len(range(0, len(rows[0][1]), every))
    figure = Figure(figsize=(1.3 * columns, 1.45 * len(rows)), layout="constrained")
    axes = np.atleast_2d(figure.subplots(len(rows), columns))
    for axis_row, (title, depth) in zip(axes, rows, strict=True):
        low, high = np.nanpercentile(depth, (1, 99))
        for axis, frame in zip(axis_row, depth[::every], strict=True):
            axis.imshow(frame, vmin=low, vmax=high, cmap="viridis")
            axis.axis("off")
        axis_row[0].annotate(title, (0, 1.04), xycoords="axes fraction", fontsize=8)
    figure.savefig(path, dpi=80)
    return Path(path)

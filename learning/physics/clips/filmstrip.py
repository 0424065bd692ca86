"""Filmstrips of clips: frames side by side, one clip a row."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np


def write_filmstrip(path: str | Path, rows: Sequence[tuple[str, np.ndarray]], every: int = 2) -> Path:
    """Draw clips under each other.

    Args:
        path: picture to write.
        rows: (title, depth (frames, H, W) [m]).
        every: which frames: 0, every, 2 every, ...
    """
    from matplotlib.figure import Figure

    pictures = [np.hstack(list(depth[::every])) for _, depth in rows]
    height, width = pictures[0].shape
    figure = Figure(figsize=(width / 60, len(rows) * (height / 60 + 0.25)), layout="constrained")
    axes = figure.subplots(len(rows), 1, squeeze=False)[:, 0]
    for axis, picture, (title, _) in zip(axes, pictures, rows, strict=True):
        low, high = np.nanpercentile(picture, (1, 99))
        axis.imshow(picture, vmin=low, vmax=high, cmap="viridis")
        axis.axis("off")
        axis.set_title(title, fontsize=8, loc="left", pad=2)
    figure.savefig(path, dpi=100)
    return Path(path)

"""Close the small gaps that a depth camera leaves in a gown.

A pixel without depth that has five or more neighbours with depth gets their mean, a few times over.  Lost pixels of an
outline and holes of a few pixels close again; of a clean clip only sharp inner corners change.  How much had to be
closed tells a real camera's clip from a rendered one.
"""

from __future__ import annotations

import numpy as np

from ....sim.compiled import njit

NEIGHBOURS = 5  # of eight
TIMES = 4


@njit()
def _closed(depth, neighbours, times):
    frames, height, width = depth.shape
    out = depth.copy()
    before = depth.copy()
    filled = seen = 0
    for t in range(frames):
        for y in range(height):
            for x in range(width):
                seen += not np.isnan(depth[t, y, x])
        for _ in range(times):
            changed = 0
            for y in range(1, height - 1):
                for x in range(1, width - 1):
                    if not np.isnan(before[t, y, x]):
                        continue
                    total, count = 0.0, 0
                    for dy in range(-1, 2):
                        for dx in range(-1, 2):
                            near = before[t, y + dy, x + dx]
                            if not np.isnan(near):
                                total += near
                                count += 1
                    if count >= neighbours:
                        out[t, y, x] = total / count
                        changed += 1
            if changed == 0:
                break
            filled += changed
            before[t] = out[t]
    return out, filled / max(seen, 1)


def fill_depth_holes(depth: np.ndarray) -> tuple[np.ndarray, float]:
    """A clip's depth with small gaps closed.

    Args:
        depth: (frames, H, W) [m], NaN where there is no gown.

    Returns:
        The same shape, and the number of closed pixels as a share of those that were there.
    """
    return _closed(np.ascontiguousarray(depth, np.float32), NEIGHBOURS, TIMES)

"""Places on the gown's sheet as weights of nodes.

A place that may be on the left or on the right then has two peaks, and no mean that is neither.
"""

from __future__ import annotations

import numpy as np

SPACING = 0.1  # of the nodes [m]
# Along x, y and z of the rest shape [m]: the widest sheet, the longest sleeve, the longest gown.
SHEET_NODES = tuple(
    tuple(round(SPACING * k, 3) for k in range(first, last + 1)) for first, last in ((-9, 9), (0, 3), (-11, 0))
)


def node_weights(places: np.ndarray) -> list[np.ndarray]:
    """Weights of the nodes of each axis: the two nodes beside a coordinate share it.

    Args:
        places: (3, h, w) on the sheet [m]; NaN where there is none.

    Returns:
        For each axis (nodes, h, w) float32 that sum to 1, or to 0 where there is no place.
    """
    found = []
    for axis, nodes in zip(np.nan_to_num(places, nan=1e3), SHEET_NODES, strict=True):
        inside = np.where(axis > 1e2, axis, np.clip(axis, nodes[0], nodes[-1]))
        away = np.abs(np.asarray(nodes, np.float32)[:, None, None] - inside) / np.float32(SPACING)
        found.append(np.clip(1.0 - away, 0.0, None).astype(np.float32))
    return found

"""Two fingers and a palm as boxes, as they go with the hand."""

from __future__ import annotations

import numpy as np

FINGER = np.array((0.022, 0.010, 0.038))  # edges: along the pad's width, across it, along the approach [m]
PALM = np.array((0.060, 0.110, 0.060))  # edges of what carries the fingers [m]
PALM_BEHIND = 0.080  # of its middle behind the fingertips [m]


def boxes_of(turn: np.ndarray, tip: np.ndarray, opening: float) -> np.ndarray:
    """(3, 15) two fingers and the palm: middle, half edges, axes as a matrix row by row, see `Solids`.

    Args:
        turn: (3, 3) of the hand: y along the closing direction, z out of the palm.
        tip: (3,) middle between the fingertips [m].
        opening: between the fingertips [m].
    """
    middles, halves = local_boxes(opening)
    return np.hstack([tip + middles @ turn.T, halves, np.tile(turn.ravel(), (3, 1))])


def local_boxes(opening: float) -> tuple[np.ndarray, np.ndarray]:
    """Middles and half edges, both (3, 3), in the frame of the hand [m]; two fingers `opening` apart, and the palm."""
    aside = opening / 2 + FINGER[1] / 2
    middles = np.array(((0.0, -aside, -FINGER[2] / 2), (0.0, aside, -FINGER[2] / 2), (0.0, 0.0, -PALM_BEHIND)))
    return middles, np.vstack([FINGER, FINGER, PALM]) / 2

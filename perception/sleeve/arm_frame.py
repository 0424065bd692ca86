"""The directions that belong to an arm: along it, up, and away from the body."""

from __future__ import annotations

import numpy as np

from ..image.cloud import unit

UP = np.array((0.0, 0.0, 1.0))


def arm_frame(arm_in_map: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors (3,) along an upper arm, towards the elbow, up across it, and across it away from the bed's middle.

    Args:
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
    """
    shoulder, along = arm_in_map[0], unit(arm_in_map[1] - arm_in_map[0])
    up = unit(UP - (UP @ along) * along)
    outwards = np.cross(along, up)
    return along, up, outwards * (np.sign(outwards[0] * shoulder[0]) or 1.0)

"""Where the bindings of a sleeve show along an arm that is, or is not, inside it."""

from __future__ import annotations

import numpy as np

from ..sim.world import Frame, Side
from .cloud import points_in_map, unit
from .colours import Surface, surfaces
from .errors import PerceptionFailure, Problem
from .estimates import WornSleeve

_ASIDE = 0.20  # from the upper arm's axis, what is farther off belongs to the other sleeve [m]
_POINTS = 15


def worn_sleeve(frame: Frame, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
    """Where along the upper arm both bindings of its sleeve show.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    colours, cloud = surfaces(frame.rgb), points_in_map(frame)
    shoulder, along = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    length = float(np.linalg.norm(along))
    found: list[np.ndarray] = []
    for binding in (Surface.ARMHOLE, Surface.CUFF):
        points = cloud[(colours == binding) & (frame.depth > 0)].reshape(-1, 3)
        aside = np.linalg.norm(np.cross(points - shoulder, unit(along)), axis=1)
        found.append(points[aside < _ASIDE])
    if min(map(len, found)) < _POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
    armhole, cuff = (float(np.median((points - shoulder) @ along)) / length**2 for points in found)
    return WornSleeve(stamp=frame.stamp, confidence=min(1.0, min(map(len, found)) / 100), side=side,
                      armhole_at=armhole, cuff_at=cuff)

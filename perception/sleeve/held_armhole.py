"""The armhole of a sleeve that a hand holds by its strap: how it hangs beside the grip."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..image.cloud import points_in_map, unit
from ..image.surfaces import Surface, surfaces

RADIUS = 0.34  # no part of the armhole hangs farther from the strap [m]
POINTS = 15


def held_armhole(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
    """All of the armhole's binding that is seen around a grip.

    Args:
        frame: of any camera.
        side: the sleeve's.
        near_in_map: (3,) fingertips that hold the strap [m].

    Returns:
        Its points, and as centre the middle of their extent; position and directions are those of the grip.

    Raises:
        PerceptionFailure: too little of it is seen.
    """
    points = held_binding(frame, Surface.ARMHOLE, near_in_map)
    if len(points) < POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"held armhole of the {side} sleeve")
    low, high = np.percentile(points, (3, 97), axis=0)
    view = unit(near_in_map - frame.pose_camera_in_map[:3, 3])
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=float(min(1.0, len(points) / 120)),
        target=SLEEVE_OF[side],
        position_in_map=np.asarray(near_in_map, float),
        approach_in_map=view,
        closing_in_map=unit(np.cross(view, (0.0, 0.0, 1.0))),
        ring_points_in_map=points,
        centre_in_map=(low + high) / 2,
    )


def held_binding(frame: Frame, binding: Surface, near_in_map: np.ndarray) -> np.ndarray:
    """Points (n, 3) of one of a sleeve's bindings that are seen around a grip at (3,) [m]."""
    points = points_in_map(frame)[(surfaces(frame.rgb) == binding) & (frame.depth > 0)].reshape(-1, 3)
    return points[np.linalg.norm(points - near_in_map, axis=1) < RADIUS]

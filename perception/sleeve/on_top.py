"""A grasp from above of cloth that is highest over an arm: in the middle of its highest part, into the cloth there."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..estimates import SLEEVE_OF, GraspPoint
from ..image.cloud import across, surface_normal


def grasp_on_top(
    frame: Frame,
    side: Side,
    points: np.ndarray,
    heights: np.ndarray,
    around: np.ndarray,
    aside: np.ndarray,
    *,
    highest: float,
    patch: float,
    confidence: float,
) -> GraspPoint:
    """The grasp in the map: into the cloth, and the fingers close along the arm.

    Args:
        frame: that shows the cloth.
        side: of the person, whose sleeve it is.
        points: (n, 3) of the cloth that may be taken [m].
        heights: (n,) of them above the arm [m].
        around: (m, 3) of all the cloth there [m].
        aside: (3,) unit vector across the arm.
        highest: share of the points, the highest, in whose middle the grasp is.
        patch: radius around it, over which the cloth's normal is taken [m].
        confidence: of the grasp, 0 to 1.
    """
    place = np.median(points[heights >= np.quantile(heights, 1.0 - highest)], axis=0)
    near = around[np.linalg.norm(around - place, axis=1) < patch]
    normal = surface_normal(near, frame.pose_camera_in_map[:3, 3])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=confidence,
        target=SLEEVE_OF[side],
        position_in_map=place,
        approach_in_map=-normal,
        closing_in_map=across(aside, -normal),
    )

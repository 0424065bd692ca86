"""Which way a held sleeve points: from its armhole's binding to its cuff's."""

from __future__ import annotations

import numpy as np

from ..sim.world import Frame, Side
from .cloud import points_in_map
from .colours import Surface, surfaces
from .errors import PerceptionFailure, Problem
from .estimates import SleeveHeading
from .held_armhole import POINTS, RADIUS


def sleeve_heading(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
    """Compare where the two bindings of a sleeve show around the grip.

    Args:
        frame: of any camera.
        side: the sleeve's.
        near_in_map: (3,) fingertips that hold the strap [m].

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    labels, cloud = surfaces(frame.rgb), points_in_map(frame)
    close = (frame.depth > 0) & (np.nan_to_num(np.linalg.norm(cloud - near_in_map, axis=2), nan=np.inf) < RADIUS)
    middles = []
    for surface in (Surface.ARMHOLE, Surface.CUFF):
        points = cloud[close & (labels == surface)]
        if len(points) < POINTS:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the {side} sleeve")
        middles.append(np.percentile(points, (5, 95), axis=0).mean(axis=0))
    fewest = min(int((close & (labels == surface)).sum()) for surface in (Surface.ARMHOLE, Surface.CUFF))
    return SleeveHeading(stamp=frame.stamp, confidence=min(1.0, fewest / 60), side=side,
                         cuff_from_armhole_in_map=middles[1] - middles[0])

"""The upper edge of a cloth that lies on a bed: where fingers that come from above take it, on the camera's side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from .garment import gown_labels
from .projection import points_in_map
from .surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class ClothEdgeTuning(Quantities):
    """Numbers of the search for an edge."""

    aside: tuple[float, float] = quantity(
        (0.16, 0.34),
        "m",
        "from the middle of the bed towards the camera, where it is looked for",
        "choice: off the body",
    )
    height: float = quantity(
        0.03,
        "m",
        "of the edge above the mattress, where it is taken",
        "measured: 0.05 m above it, trunk and legs were in the fingers' way (103, 105, 107); lower, the mattress is",
    )
    strip: float = quantity(0.03, "m", "of the width that is looked at for that", "choice: half a cell of cloth")
    headmost: float = quantity(0.03, "1", "share of those points, nearest to the head, that is the edge", "choice: tip")
    min_points: int = quantity(40, "1", "of cloth in a strip", "choice: fewer are noise")
    confidence: float = quantity(0.9, "1", "in the grasp", "choice: a plain thing that shows whole")


DEFAULT = ClothEdgeTuning()


def cloth_edge(frame: Frame, bed_in_map: np.ndarray, tuning: ClothEdgeTuning = DEFAULT) -> GraspPoint:
    """Where the edge nearest to the head of the bed is, on the side from which the camera looks.

    Args:
        frame: of a camera beside the bed; nothing else in it has the colour of fabric.
        bed_in_map: (2, 3) two opposite corners of the bed's top [m].
        tuning: numbers of the search.

    Returns:
        Target `near_hang`: what is taken first.  The fingers come from above and close across the edge.

    Raises:
        PerceptionFailure: too little cloth lies there.
    """
    middle = bed_in_map[:, :2].mean(axis=0)
    outward = float(np.sign(frame.pose_camera_in_map[0, 3] - middle[0]))
    points = points_in_map(frame)[(gown_labels(frame) != Surface.OTHER) & (frame.depth > 0)]
    points = points[points[:, 2] > bed_in_map[:, 2].max() - tuning.strip]  # what hangs over the foot is no edge
    aside = outward * (points[:, 0] - middle[0])
    edges = []
    for start in np.arange(*tuning.aside, tuning.strip):
        there = points[(aside >= start) & (aside < start + tuning.strip)]
        if len(there) >= tuning.min_points:
            edges.append(np.median(there[there[:, 1] <= np.quantile(there[:, 1], tuning.headmost)], axis=0))
    if not edges:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "upper edge of a cloth on the bed")
    wanted = bed_in_map[:, 2].max() + tuning.height
    edge = min(edges, key=lambda edge: abs(edge[2] - wanted))
    return GraspPoint(
        stamp=frame.stamp,
        confidence=tuning.confidence,
        target="near_hang",
        position_in_map=edge,
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )

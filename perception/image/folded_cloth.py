"""A folded cloth that stands or lies on something flat: where fingers that come from above take it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from .cloud import clusters, thinned
from .garment import gown_labels
from .projection import points_in_map
from .surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class FoldedClothTuning(Quantities):
    """Numbers of the grasp on a folded cloth."""

    gap: float = quantity(0.03, "m", "between points of one cloth", "choice: pixels are some millimetres apart")
    top_share: float = quantity(0.9, "1", "of the points that lie below its top", "choice: depth noise, and one edge")
    top_band: float = quantity(0.015, "m", "below the top that still counts as top", "choice: above depth noise")
    min_points: int = quantity(12, "1", "of the top that tell how it lies", "choice: fewer are noise")
    depth: float = quantity(0.02, "m", "of the grasp below the top", "choice: half of a finger's pad, as it goes on")
    confidence: float = quantity(0.9, "1", "in the grasp", "choice: a plain thing that shows whole")


DEFAULT = FoldedClothTuning()
DOWN = np.array((0.0, 0.0, -1.0))


def folded_cloth(frame: Frame, tuning: FoldedClothTuning = DEFAULT) -> GraspPoint:
    """The middle of a folded cloth, below its top; the fingers come from above and close across its short side.

    Args:
        frame: of a camera that sees the cloth from above; nothing else in it has the colour of fabric.
        tuning: numbers of the grasp.

    Returns:
        Target `near_hang`: what is taken first.

    Raises:
        PerceptionFailure: no cloth, or too little of its top.
    """
    import cv2

    seen = (gown_labels(frame) != Surface.OTHER) & (frame.depth > 0)
    points = thinned(points_in_map(frame)[seen])
    points = points[clusters(points, tuning.gap) == 0]
    high = np.quantile(points[:, 2], tuning.top_share)
    top = points[points[:, 2] > high - tuning.top_band]
    if len(top) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "top of a folded cloth")
    (x, y), (width, length), angle = cv2.minAreaRect(top[:, :2].astype(np.float32))
    short = np.deg2rad(angle if width < length else angle + 90.0)
    return GraspPoint(
        stamp=frame.stamp,
        confidence=tuning.confidence,
        target="near_hang",
        position_in_map=np.array((x, y, high - tuning.depth)),
        approach_in_map=DOWN.copy(),
        closing_in_map=np.array((math.cos(short), math.sin(short), 0.0)),
    )

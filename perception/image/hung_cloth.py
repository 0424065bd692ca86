"""A cloth that hangs from one point: where fingers take it, a little below that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from .cloud import across, clusters, thinned, unit
from .garment import gown_labels
from .projection import points_in_map
from .surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class HungClothTuning(Quantities):
    """Numbers of the grasp on a hung cloth."""

    gap: float = quantity(0.04, "m", "between points of one cloth", "choice: pixels are some millimetres apart")
    top_share: float = quantity(0.995, "1", "of the points that lie below its top", "choice: depth noise")
    below: float = quantity(0.06, "m", "of the grasp below the top", "choice: the fingers clear the hook")
    band: float = quantity(0.015, "m", "above and below the grasp, of the points it lies among", "choice: a finger")
    min_points: int = quantity(8, "1", "of those", "choice: fewer are noise")
    confidence: float = quantity(0.9, "1", "in the grasp", "choice: a plain thing that shows whole")


DEFAULT = HungClothTuning()


def hung_cloth(frame: Frame, tuning: HungClothTuning = DEFAULT) -> GraspPoint:
    """The middle of a hung cloth, a little below its top; the fingers come level and close across its vertical folds.

    Args:
        frame: of a camera that sees the cloth; nothing else in it has the colour of fabric.
        tuning: numbers of the grasp.

    Returns:
        Target `near_hang`.

    Raises:
        PerceptionFailure: no cloth, or too little of it below its top.
    """
    seen = (gown_labels(frame) != Surface.OTHER) & (frame.depth > 0)
    points = thinned(points_in_map(frame)[seen])
    points = points[clusters(points, tuning.gap) == 0]
    height = float(np.quantile(points[:, 2], tuning.top_share)) - tuning.below
    there = points[np.abs(points[:, 2] - height) < tuning.band]
    if len(there) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "top of a hung cloth")
    position = np.append(np.median(there[:, :2], axis=0), height)
    approach = unit((position - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0))
    return GraspPoint(
        stamp=frame.stamp,
        confidence=tuning.confidence,
        target="near_hang",
        position_in_map=position,
        approach_in_map=approach,
        closing_in_map=across(np.array((0.0, 0.0, 1.0)), approach),
    )

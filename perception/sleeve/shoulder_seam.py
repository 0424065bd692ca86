"""The outer end of a worn gown's shoulder seam, beside the shoulder: what is drawn behind it to seat the sleeve.

No tape is looked for: beside the shoulder, at the height of the arm, the seam's end is what of the gown lies nearest to
the person's head.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, GraspPoint
from ..image.cloud import across, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES

UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class ShoulderSeamTuning(Quantities):
    """Numbers of where the end of a shoulder seam lies."""

    outward: tuple[float, float] = quantity(
        (0.06, 0.35),
        "m",
        "from the shoulder, off the body, between which it is looked for",
        "measured: in five recorded states it lay 0.09 to 0.24 m off it",
    )
    height: tuple[float, float] = quantity(
        (-0.04, 0.05),
        "m",
        "above the shoulder, between which cloth counts",
        "choice: below it lies the back panel on the bed, above it the neckline stands up",
    )
    headmost: float = quantity(
        0.1, "1", "share of that cloth, the nearest to the head, whose middle is taken", "choice: an edge, not a speck"
    )
    inset: float = quantity(0.01, "m", "of the grasp from there into the cloth", "choice: half a finger's width")
    min_points: int = quantity(30, "1", "of cloth there", "choice: fewer are an edge of it")
    full_points: int = quantity(300, "1", "of cloth that make it certain", "choice: seen from close by")


DEFAULT = ShoulderSeamTuning()


def shoulder_seam(
    frame: Frame, side: Side, shoulders_in_map: np.ndarray, tuning: ShoulderSeamTuning = DEFAULT
) -> GraspPoint:
    """The outer end of the seam over a shoulder.

    Args:
        frame: of any camera, from the head of the bed.
        side: of the person.
        shoulders_in_map: (2, 3) left and right [m].
        tuning: numbers of the search.

    Returns:
        The grasp in the map: from above, and the fingers close across the edge, towards the person's head.

    Raises:
        PerceptionFailure: too little of the gown is seen there.
    """
    left, right = shoulders_in_map
    headward = unit(np.cross(right - left, UP))
    n = SIDES.index(side)
    outward = unit(shoulders_in_map[n] - shoulders_in_map[1 - n])
    cloth = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
    off = cloth - shoulders_in_map[n]
    beside, above = off @ outward, off[:, 2]
    near = cloth[_between(beside, tuning.outward) & _between(above, tuning.height)]
    if len(near) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"seam over the {side} shoulder")
    towards_head = near @ headward
    edge = np.median(near[towards_head >= np.quantile(towards_head, 1.0 - tuning.headmost)], axis=0)
    return GraspPoint(
        stamp=frame.stamp,
        confidence=min(1.0, len(near) / tuning.full_points),
        target=SLEEVE_OF[side],
        position_in_map=edge - tuning.inset * headward,
        approach_in_map=-UP,
        closing_in_map=across(outward, -UP),
    )


def _between(values: np.ndarray, bounds: tuple[float, float]) -> np.ndarray:
    """(n,) bool, which values lie between the two bounds."""
    return (bounds[0] < values) & (values < bounds[1])

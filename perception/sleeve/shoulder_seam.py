"""The outer end of a worn gown's shoulder seam, beside the shoulder: what is drawn behind it to seat the sleeve.

It is what lies nearest to the person's head of the gown beside the armhole's tape, which ends there: the corner of the
back panel may lie farther headward yet.  Where no tape shows, it is what lies nearest to the head at the height of the
arm.
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
from ..image.surfaces import GOWN_SURFACES, Surface

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
        "above the shoulder, between which cloth counts where no tape shows",
        "choice: below it lies the back panel on the bed, above it the neckline stands up",
    )
    height_by_tape: tuple[float, float] = quantity(
        (-0.08, 0.15),
        "m",
        "above the shoulder, between which tape and cloth beside it count",
        "measured: the seam's end stood up to 0.10 m above it (103)",
    )
    footward: float = quantity(
        0.2, "m", "of the shoulder, to which tape counts", "measured: 0.02 to 0.19 m in 94 views of recorded states"
    )
    tape_end: float = quantity(0.05, "1", "share of the tape, the nearest to the head, that is its end", "choice: tip")
    by_tape: float = quantity(
        0.09,
        "m",
        "from the tape's end, to which cloth counts",
        "measured: of 94 views 2 took the back panel's corner, 2 the armhole's side; 0.05 m: 3 and 7; 0.12 m: 11 "
        "and 6; without the tape 12 and 5",
    )
    min_tape: int = quantity(10, "1", "points of tape there", "choice: fewer are noise")
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
    labels, points = gown_labels(frame), points_in_map(frame) - shoulders_in_map[n]
    beside = (frame.depth > 0) & _between(points @ outward, tuning.outward)
    reached = beside & _between(points[..., 2], tuning.height_by_tape) & (points @ headward > -tuning.footward)
    gown = np.isin(labels, GOWN_SURFACES)
    tape = points[reached & (labels == Surface.ARMHOLE)]
    if len(tape) < tuning.min_tape:
        near = points[beside & gown & _between(points[..., 2], tuning.height)]
    else:
        near = points[reached & gown]
        near = near[np.linalg.norm(near - _headmost(tape, headward, tuning.tape_end), axis=1) < tuning.by_tape]
    if len(near) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"seam over the {side} shoulder")
    edge = shoulders_in_map[n] + _headmost(near, headward, tuning.headmost)
    return GraspPoint(
        stamp=frame.stamp,
        confidence=min(1.0, len(near) / tuning.full_points),
        target=SLEEVE_OF[side],
        position_in_map=edge - tuning.inset * headward,
        approach_in_map=-UP,
        closing_in_map=across(outward, -UP),
    )


def _headmost(points: np.ndarray, headward: np.ndarray, share: float) -> np.ndarray:
    """(3,) middle of that share of points (n, 3) which lies nearest to the head."""
    towards_head = points @ headward
    return np.median(points[towards_head >= np.quantile(towards_head, 1.0 - share)], axis=0)


def _between(values: np.ndarray, bounds: tuple[float, float]) -> np.ndarray:
    """Array of bool, which values lie between the two bounds."""
    return (bounds[0] < values) & (values < bounds[1])

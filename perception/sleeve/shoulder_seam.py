"""The outer end of a worn gown's shoulder seam, beside the shoulder: what is drawn behind it to seat the sleeve.

The seam runs from the end of the neckline's tape along the armhole's tape.  It is what of the gown lies nearest to the
person's head there, where both tapes are close: the corner of the back panel, farther along the edge, may lie farther
headward yet.  Where either tape does not show, it is what lies nearest to the head at the height of the arm.
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
        "above the shoulder, between which cloth counts where either tape does not show",
        "choice: below it lies the back panel on the bed, above it the neckline stands up",
    )
    height_by_tape: tuple[float, float] = quantity(
        (-0.08, 0.20),
        "m",
        "above the shoulder, between which tapes and cloth beside them count",
        "measured: the seam's end stood up to 0.10 m above it (103)",
    )
    footward: float = quantity(
        0.2, "m", "of the shoulder, to which tape counts", "measured: 0.02 to 0.19 m in 94 views of recorded states"
    )
    nearest: float = quantity(
        0.05, "1", "share of the armhole's tape, the nearest to the neckline's, where the seam is", "choice: a tip"
    )
    by_armhole: float = quantity(
        0.12,
        "m",
        "from there, to which cloth counts",
        "measured: of 144 views it was the seam in 119, the back panel's corner in 14; in 37 and 99 where what lay "
        "nearest to the head beside the armhole's tape was taken",
    )
    by_neckline: tuple[float, float] = quantity(
        (0.02, 0.14),
        "m",
        "from the neckline's tape, between which cloth counts",
        "measured: likewise; from 0 to 0.12 m the seam in 111, to 0.20 m in 107",
    )
    neckline: tuple[float, float] = quantity(
        (-0.2, 0.4), "m", "from the shoulder, off the body, between which that tape counts", "choice: its half"
    )
    min_tape: int = quantity(10, "1", "points of either tape there", "choice: fewer are noise")
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
    gown = np.isin(labels, GOWN_SURFACES) & (frame.depth > 0)
    near = _by_both_tapes(labels, points, gown, outward, headward, tuning)
    if len(near) < tuning.min_points:
        near = points[gown & _between(points @ outward, tuning.outward) & _between(points[..., 2], tuning.height)]
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


def _by_both_tapes(
    labels: np.ndarray,
    points: np.ndarray,
    gown: np.ndarray,
    outward: np.ndarray,
    headward: np.ndarray,
    tuning: ShoulderSeamTuning,
) -> np.ndarray:
    """(n, 3) of the points (H, W, 3) of the gown that lie where the tapes of armhole and neckline are close.

    Args:
        labels: (H, W) of each point.
        points: (H, W, 3) from the shoulder [m].
        gown: (H, W) bool.
        outward: (3,) off the body.
        headward: (3,) towards the head.
        tuning: numbers of the search.
    """
    from scipy.spatial import KDTree

    reached = gown & _between(points[..., 2], tuning.height_by_tape) & (points @ headward > -tuning.footward)
    beside = reached & _between(points @ outward, tuning.outward)
    neckline = points[reached & (labels == Surface.COLLAR) & _between(points @ outward, tuning.neckline)]
    armhole, cloth = points[beside & (labels == Surface.ARMHOLE)], points[beside]
    if min(len(neckline), len(armhole)) < tuning.min_tape:
        return np.zeros((0, 3))
    tape = KDTree(neckline)
    off = tape.query(armhole)[0]
    meet = np.median(armhole[off <= np.quantile(off, tuning.nearest)], axis=0)
    close = np.linalg.norm(cloth - meet, axis=1) < tuning.by_armhole
    return cloth[close & _between(tape.query(cloth)[0], tuning.by_neckline)]


def _headmost(points: np.ndarray, headward: np.ndarray, share: float) -> np.ndarray:
    """(3,) middle of that share of points (n, 3) which lies nearest to the head."""
    towards_head = points @ headward
    return np.median(points[towards_head >= np.quantile(towards_head, 1.0 - share)], axis=0)


def _between(values: np.ndarray, bounds: tuple[float, float]) -> np.ndarray:
    """Array of bool, which values lie between the two bounds."""
    return (bounds[0] < values) & (values < bounds[1])

"""Where the hung gown hangs, and a place near there to take it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from ..image.cloud import across, main_direction, unit
from ..image.garment import gown_labels
from ..image.projection import pixel_scale, points_in_map
from ..image.surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class HangPointTuning(Quantities):
    """Numbers of the grasp near the hanging point."""

    distance: tuple[float, float] = quantity(
        (70.0, 80.0), "px", "of the grasp from the hanging point, in the paper's pictures", "paper: 70 to 80 px"
    )
    top_rows: int = quantity(
        2, "px", "below the highest pixel that are its top", "choice: one noisy pixel does not decide"
    )
    min_tape_points: int = quantity(3, "1", "of the neckline at that distance", "choice: fewer are noise")
    neighbourhood: int = quantity(
        2,
        "px",
        "to every side of the chosen pixel, of those whose median is taken",
        "choice: depth noise and edges vanish",
    )
    tape_distance: float = quantity(0.06, "m", "from the grasp, of tape that tells its edge", "choice: a tape's width")
    min_edge_points: int = quantity(8, "1", "of that tape", "choice: fewer tell no direction")
    tape_confidence: float = quantity(0.9, "1", "in a grasp on the neckline's tape", "choice: an edge to close across")
    fabric_confidence: float = quantity(0.6, "1", "in a grasp on fabric", "choice: less than on an edge")


DEFAULT = HangPointTuning()


def hang_pixel(labels: np.ndarray, tuning: HangPointTuning = DEFAULT) -> tuple[float, float]:
    """Pixel (u, v) of the highest part of the largest patch of gown in `labels` (H, W) of `Surface` values."""
    import cv2

    gown = (labels != Surface.OTHER).astype(np.uint8)
    count, patches, stats, _ = cv2.connectedComponentsWithStats(gown, connectivity=8)
    largest = 1 + int(np.argmax(stats[1:count, cv2.CC_STAT_AREA]))
    rows, columns = np.nonzero(patches == largest)
    top = rows <= rows.min() + tuning.top_rows
    return float(np.median(columns[top])), float(rows.min())


def grasp_near_hang(frame: Frame, rng: np.random.Generator, tuning: HangPointTuning = DEFAULT) -> GraspPoint:
    """A random place 70 to 80 px of the paper's pictures from the hanging point, on the neckline where it is seen.

    The fingers come horizontally from the camera's side and close across the tape's edge, or across the vertical folds
    where there is only fabric.

    Args:
        frame: of a camera that sees the hung gown.
        rng: of the choice among the places.
        tuning: numbers of the grasp.

    Raises:
        PerceptionFailure: no gown, or none of it with depth at that distance (`OUT_OF_REACH`).
    """
    labels = gown_labels(frame)
    u0, v0 = hang_pixel(labels, tuning)
    rows, columns = np.nonzero((labels != Surface.OTHER) & (frame.depth > 0))
    away = np.hypot(columns - u0, rows - v0) / pixel_scale(frame)
    low, high = tuning.distance
    there = (away >= low) & (away <= high)
    points = points_in_map(frame)[rows, columns]
    if not there.any():
        raise PerceptionFailure(Problem.OUT_OF_REACH, "gown near its hanging point")
    tape = there & (labels[rows, columns] == Surface.COLLAR)
    on_tape = tape.sum() >= tuning.min_tape_points
    choice = tape if on_tape else there
    picked = int(rng.choice(np.flatnonzero(choice)))
    # depth noise and a pixel of the background behind the edge both vanish in the median of close neighbours
    close = np.abs(columns - columns[picked]) <= tuning.neighbourhood
    close &= np.abs(rows - rows[picked]) <= tuning.neighbourhood
    position = np.median(points[close], axis=0)
    approach = position - frame.pose_camera_in_map[:3, 3]
    approach = unit(np.array((approach[0], approach[1], 0.0)))
    edge = np.array((0.0, 0.0, 1.0))
    if on_tape:
        near = np.linalg.norm(points - position, axis=1) < tuning.tape_distance
        strip = (labels[rows, columns] == Surface.COLLAR) & near
        if strip.sum() >= tuning.min_edge_points:
            edge = main_direction(points[strip])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=tuning.tape_confidence if on_tape else tuning.fabric_confidence,
        target="near_hang",
        position_in_map=position,
        approach_in_map=approach,
        closing_in_map=across(edge, approach),
    )

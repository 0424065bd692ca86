"""Stage A: where the hung gown hangs, and a place near there to take it."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from ..image.cloud import across, main_direction, pixel_scale, points_in_map, unit
from ..image.garment import gown_labels
from ..image.surfaces import Surface

_RING = (70.0, 80.0)  # distance from the hanging point in the paper's images [px], from the paper


def hang_pixel(labels: np.ndarray) -> tuple[float, float]:
    """Pixel (u, v) of the highest part of the largest patch of gown in `labels` (H, W)."""
    import cv2

    gown = (labels != Surface.OTHER).astype(np.uint8)
    count, patches, stats, _ = cv2.connectedComponentsWithStats(gown, connectivity=8)
    largest = 1 + int(np.argmax(stats[1:count, cv2.CC_STAT_AREA]))
    rows, columns = np.nonzero(patches == largest)
    top = rows <= rows.min() + 2  # a few rows, so that one noisy pixel does not decide
    return float(np.median(columns[top])), float(rows.min())


def grasp_near_hang(frame: Frame, rng: np.random.Generator) -> GraspPoint:
    """A random place 70-80 px (of the paper's images) from the hanging point, on the neck binding where it is seen.

    The fingers come horizontally from the camera's side and close across the binding's edge, or across the
    vertical folds where there is only fabric.

    Raises:
        PerceptionFailure: no gown, or none of it with depth at that distance (`OUT_OF_REACH`).
    """
    labels = gown_labels(frame)
    u0, v0 = hang_pixel(labels)
    rows, columns = np.nonzero((labels != Surface.OTHER) & (frame.depth > 0))
    away = np.hypot(columns - u0, rows - v0) / pixel_scale(frame)
    ring = (away >= _RING[0]) & (away <= _RING[1])
    points = points_in_map(frame)[rows, columns]
    if not ring.any():
        raise PerceptionFailure(Problem.OUT_OF_REACH, "gown near its hanging point")
    binding = ring & (labels[rows, columns] == Surface.COLLAR)
    choice = binding if binding.sum() >= 3 else ring
    picked = int(rng.choice(np.flatnonzero(choice)))
    # depth noise and a pixel of the background behind the edge both vanish in the median of close neighbours
    close = (np.abs(columns - columns[picked]) <= 2) & (np.abs(rows - rows[picked]) <= 2)
    position = np.median(points[close], axis=0)
    approach = position - frame.pose_camera_in_map[:3, 3]
    approach = unit(np.array((approach[0], approach[1], 0.0)))
    edge = np.array((0.0, 0.0, 1.0))
    if binding.sum() >= 3:
        strip = (labels[rows, columns] == Surface.COLLAR) & (np.linalg.norm(points - position, axis=1) < 0.06)
        if strip.sum() >= 8:
            edge = main_direction(points[strip])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=0.9 if choice is binding else 0.6,
        target="near_hang",
        position_in_map=position,
        approach_in_map=approach,
        closing_in_map=across(edge, approach),
    )

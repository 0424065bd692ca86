"""The neck binding: its two ends, and its part near a shoulder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import COLLAR_OF, GraspPoint
from ..image.cloud import (
    across,
    clusters,
    geodesic,
    main_direction,
    pixel_scale,
    points_in_map,
    project,
    surface_normal,
    unit,
)
from ..image.garment import gown_labels
from ..image.surfaces import Surface

_MOST = 1200  # points of the binding that are worked on
_END = 0.06  # the end of the binding is grasped in the middle of that much of it [m]
_AROUND, _RIM = 0.3, 40  # the armhole of a shoulder is that near [m]; points of it to look at
_GAP = 0.03  # larger steps between neighbours are depth steps [m]


@dataclass(frozen=True)
class CornerCandidate:
    """One end of a visible piece of binding.

    Attributes:
        position_in_map: (3,) [m].
        outward_in_map: (3,) unit vector along the binding, off its end.
        score: 0 to 1, how much it looks like a corner rather than a fold or something in front.
    """

    position_in_map: np.ndarray
    outward_in_map: np.ndarray
    score: float


def _binding(frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (n, 2) as (u, v) and points (n, 3) of the neck binding, thinned evenly."""
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels == Surface.COLLAR) & (frame.depth > 0))
    if len(rows) < 15:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neck binding of the gown")
    points = points_in_map(frame)[rows, columns]
    step = max(1, len(rows) // _MOST + (len(rows) % _MOST > 0))
    return np.column_stack([columns, rows])[::step], points[::step]


def corner_candidates(frame: Frame) -> list[CornerCandidate]:
    """Ends of every visible piece of the neck binding, best first.

    A piece of binding ends at a corner, where it turns out of sight, behind other cloth or at the image's
    border.  At a corner the armhole begins: its binding is close.

    Raises:
        PerceptionFailure: no gown or no binding.
    """
    pixels, points = _binding(frame)
    armhole = _armhole_points(frame)
    labels = clusters(points, _GAP)
    found = []
    for piece in range(labels.max() + 1):
        mine = np.flatnonzero(labels == piece)
        if len(mine) < 12:
            break  # pieces are sorted by size
        cloud, uv = points[mine], pixels[mine]
        tips = [int(np.argmax(geodesic(cloud, 0, _GAP)))]
        along = geodesic(cloud, tips[0], _GAP)
        tips.append(int(np.argmax(along)))
        for tip in tips:
            from_tip = along if tip == tips[0] else geodesic(cloud, tip, _GAP)
            end, behind = from_tip < 0.03, (from_tip > 0.05) & (from_tip < 0.11)
            if behind.sum() < 4:
                continue
            position = np.median(cloud[end], axis=0)
            outward = unit(position - np.median(cloud[behind], axis=0))
            score = _corner_score(frame, cloud[end], uv[tip], armhole)
            found.append(CornerCandidate(position, outward, score))
    if not found:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "end of the neck binding")
    return sorted(found, key=lambda c: -c.score)


def _armhole_points(frame: Frame) -> np.ndarray:
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels == Surface.ARMHOLE) & (frame.depth > 0))
    return points_in_map(frame)[rows, columns]


def _corner_score(frame: Frame, end: np.ndarray, tip: np.ndarray, armhole: np.ndarray) -> float:
    """How much the end of a strip (n, 3), with its last pixel `tip`, looks like a corner (0 to 1)."""
    height, width = frame.depth.shape
    if not (4 < tip[0] < width - 5 and 4 < tip[1] < height - 5):
        return 0.05  # it leaves the image
    position = np.median(end, axis=0)
    close = int((np.linalg.norm(armhole - position, axis=1) < 0.08).sum()) if len(armhole) else 0
    size = min(1.0, len(end) / 20)
    towards = frame.pose_camera_in_map[:3, 3]
    facing = abs(surface_normal(end, towards) @ unit(towards - position))
    return float((0.25 + 0.75 * min(1.0, close / 10)) * (0.4 + 0.6 * size) * (0.4 + 0.6 * facing))


def collar_near_shoulder(frame: Frame, side: Side, shoulder_in_map: np.ndarray) -> GraspPoint:
    """Stage D: the end of the neck binding at the armhole that sits near the person's shoulder.

    The paper takes a random place within 150 px of its images; the end next to the armhole pulls the most at the
    sleeve.  Where no armhole shows, it is the place nearest to the shoulder.

    Args:
        frame: a view from above the person.
        side: of the person.
        shoulder_in_map: (3,) from the tracked posture [m].

    Raises:
        PerceptionFailure: no binding is seen within those 150 px.
    """
    pixels, points = _binding(frame)
    u, v, _ = project(frame, shoulder_in_map)[0]
    near = np.hypot(pixels[:, 0] - u, pixels[:, 1] - v) <= 150 * pixel_scale(frame)
    if near.sum() < 8:
        raise PerceptionFailure(Problem.OUT_OF_REACH, f"neck binding near the {side} shoulder")
    points = points[near]
    away = np.linalg.norm(points - shoulder_in_map, axis=1)
    armhole = _armhole_points(frame)
    armhole = armhole[np.linalg.norm(armhole - shoulder_in_map, axis=1) < _AROUND]
    if len(armhole) >= _RIM:
        away = 0.3 * away + np.linalg.norm(points[:, None] - armhole[:: len(armhole) // _RIM], axis=2).min(axis=1)
    end = np.median(points[away <= np.sort(away)[7]], axis=0)
    strip = points[np.linalg.norm(points - end, axis=1) < _END]
    position = np.median(strip, axis=0)
    normal = surface_normal(strip, frame.pose_camera_in_map[:3, 3])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=min(1.0, near.sum() / 60),
        target=COLLAR_OF[side],
        position_in_map=position,
        approach_in_map=-normal,
        closing_in_map=across(main_direction(strip), -normal),
    )

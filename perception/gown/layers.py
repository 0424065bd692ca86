"""What the fingers hold: is there cloth, and how many layers of it will be between them.

Thin cloth does not keep the fingers apart measurably, and once they are closed the layers lie on each other, so
layers are counted before: in the volume that the open fingers sweep when they close.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.mechanics.gripper import GRIPPER
from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import Estimate, LayerCount
from ..image.cloud import clusters
from ..image.projection import points_in_map, project
from ..image.surfaces import GOWN_SURFACES, surfaces


@dataclass(frozen=True, kw_only=True)
class LayersTuning(Quantities):
    """Numbers of what counts as cloth between the fingers."""

    held_distance: float = quantity(
        0.045, "m", "from the point between the fingertips, of cloth that they hold", "choice: somewhat beyond the pads"
    )
    min_tip_depth: float = quantity(0.02, "m", "of the fingertips before the camera", "choice: nearer is out of view")
    full_held_share: float = quantity(
        0.06,
        "1",
        "of the disc around the fingertips, covered with cloth, that makes it certain",
        "choice: a pinched corner covers a tenth of the disc, and the fingers most of the rest",
    )
    hidden_share: float = quantity(
        0.5,
        "1",
        "of that disc behind cloth nearer to the camera, from which nobody can tell",
        "measured: a flap of the back panel that stood up before the camera covered all of it (106)",
    )
    volume_half_width: float = quantity(
        0.014, "m", "of the volume that closing fingers sweep, across the pads", "choice: a pad and 3 mm on either side"
    )
    volume_beyond: float = quantity(0.006, "m", "of that volume, past the fingertips", "choice: above depth noise")
    sheet_distance: float = quantity(
        0.012, "m", "between points of one sheet", "choice: points farther from each other are on different sheets"
    )
    min_sheet_points: int = quantity(4, "1", "of a sheet", "choice: fewer are noise")
    min_sheet_share: float = quantity(0.04, "1", "of all points in the volume, of a sheet", "choice: less is noise")
    max_points: int = quantity(600, "1", "in the volume that are worked on", "choice: bounds the computing time")
    none_confidence: float = quantity(0.8, "1", "in no layer", "choice: cloth may hide from every view")
    one_confidence: tuple[float, float, float] = quantity(
        (0.84, 0.01, 0.89),
        "1",
        "in one layer: without a view, more for each view, and at most",
        "measured: 144 volumes of rendered gowns; of those counted as one, 0.85 (one view) to 0.89 (six) were",
    )
    two_confidence: float = quantity(
        0.95, "1", "in two layers", "measured: 144 volumes of rendered gowns; of those counted as two, 0.95 were"
    )


DEFAULT = LayersTuning()


def gripped_cloth(frame: Frame, pose_hand_in_map: np.ndarray, tuning: LayersTuning = DEFAULT) -> Estimate:
    """How sure it is that the fingers hold cloth: confidence 0 (nothing there) to 1.

    Args:
        frame: any view of the fingertips.
        pose_hand_in_map: (4, 4) of the hand, from the joint angles.
        tuning: numbers of what counts as held.

    Raises:
        PerceptionFailure: the fingertips are outside the image, behind other cloth, or there is no depth at all.
    """
    height, width = frame.depth.shape
    tip = project(frame, pose_hand_in_map[:3, 3])[0]
    if not (tip[2] > tuning.min_tip_depth and 0 <= tip[0] < width and 0 <= tip[1] < height):
        raise PerceptionFailure(Problem.OUT_OF_REACH, "fingertips")
    if not (frame.depth > 0).any():
        raise PerceptionFailure(Problem.NO_DEPTH, "fingertips")
    gown = np.isin(surfaces(frame.rgb), GOWN_SURFACES) & (frame.depth > 0)
    near = np.linalg.norm(points_in_map(frame)[gown] - pose_hand_in_map[:3, 3], axis=1) < tuning.held_distance
    radius = tuning.held_distance * frame.intrinsics[0] / tip[2]
    rows, columns = np.mgrid[0:height, 0:width]
    inside = (columns - tip[0]) ** 2 + (rows - tip[1]) ** 2 < radius**2
    if (gown & (frame.depth < tip[2] - tuning.held_distance))[inside].mean() > tuning.hidden_share:
        raise PerceptionFailure(Problem.HIDDEN, "fingertips")
    disc = np.pi * radius**2
    return Estimate(stamp=frame.stamp, confidence=float(min(1.0, near.sum() / (tuning.full_held_share * disc))))


def layers(
    frames: Sequence[Frame],
    side: Side,
    pose_hand_in_map: np.ndarray,
    poses_cloth_in_map: Sequence[np.ndarray] | None = None,
    opening: float = GRIPPER.stroke,
    tuning: LayersTuning = DEFAULT,
) -> LayerCount:
    """Count the sheets of cloth in the volume between open fingers: 0, 1 or 2 (two or more).

    Points of several views are put together.  A sheet hidden in all of them is not counted, so one layer is
    less certain the fewer views there are.

    Args:
        frames: views of the cloth, the last one the most recent.
        side: which hand.
        pose_hand_in_map: (4, 4) of the open hand around the cloth, from the joint angles.
        poses_cloth_in_map: (4, 4) at each frame of what carries the cloth (the other hand), if that moved in between.
        opening: of the fingers [m].
        tuning: numbers of what counts as a sheet.

    Raises:
        PerceptionFailure: no gown in any of the frames.
    """
    clouds = []
    for k, frame in enumerate(frames):
        points = _gown_points(frame)
        if poses_cloth_in_map is not None:
            then, now = poses_cloth_in_map[k], poses_cloth_in_map[-1]
            points = (points - then[:3, 3]) @ then[:3, :3] @ now[:3, :3].T + now[:3, 3]
        clouds.append(points)
    everything = np.vstack(clouds)
    if not len(everything):
        raise PerceptionFailure(Problem.NOTHING_SEEN, "gown")
    inside = _between(everything, pose_hand_in_map, opening, tuning)
    views = sum(len(_between(cloud, pose_hand_in_map, opening, tuning)) > 0 for cloud in clouds)
    stamp = frames[-1].stamp
    if len(inside) < tuning.min_sheet_points:
        return LayerCount(stamp=stamp, confidence=tuning.none_confidence, side=side, layers=0)
    if len(inside) > tuning.max_points:
        inside = inside[:: len(inside) // tuning.max_points + 1]
    sizes = np.bincount(clusters(inside, tuning.sheet_distance))
    sheets = int((sizes >= max(tuning.min_sheet_points, tuning.min_sheet_share * len(inside))).sum())
    least, each, most = tuning.one_confidence
    confidence = min(most, least + each * views) if sheets == 1 else tuning.two_confidence
    return LayerCount(stamp=stamp, confidence=confidence, side=side, layers=min(sheets, 2))


def _between(points: np.ndarray, pose_hand_in_map: np.ndarray, opening: float, tuning: LayersTuning) -> np.ndarray:
    """Those of `points` (n, 3) in the map that fingers `opening` apart take when they close: (k, 3) in the hand [m]."""
    local = (points - pose_hand_in_map[:3, 3]) @ pose_hand_in_map[:3, :3]
    return local[
        (np.abs(local[:, 0]) < tuning.volume_half_width)
        & (np.abs(local[:, 1]) < opening / 2)
        & (local[:, 2] > -GRIPPER.pad_length)
        & (local[:, 2] < tuning.volume_beyond)
    ]


def _gown_points(frame: Frame) -> np.ndarray:
    """(n, 3) points of the gown in the map [m]."""
    labels = surfaces(frame.rgb)
    seen = np.isin(labels, GOWN_SURFACES) & (frame.depth > 0)
    return points_in_map(frame)[seen]

"""The shoulders of a gown on its hook: where each hand takes one of them."""

from __future__ import annotations

import numpy as np

from ..sim.world import Frame, Side
from .cloud import clusters, points_in_map
from .colours import GOWN_SURFACES, Surface, surfaces
from .errors import PerceptionFailure, Problem
from .estimates import SLEEVE_OF, GraspPoint

GAP = 0.02  # points of one patch of binding lie nearer together than this [m]
POINTS = 10  # a smaller patch is noise
STRIP = 0.10  # below the top the neckline has parted into two strips [m]
FALL = 0.16  # a strip that is seen this far below the top shows its end [m]


def hung_sleeve(frame: Frame, side: Side) -> GraspPoint:
    """The shoulder on one side of a gown that hangs by the middle of its neckline, outside to the camera.

    The neckline's binding falls to both sides of the hook in two strips whose lower ends are at the shoulders.  Where
    a fold hides a strip, the upper end of that side's armhole binding serves.

    Args:
        frame: of a camera that sees the gown's outside.
        side: the wearer's side; seen from outside, the wearer's right is on the left of the picture.

    Returns:
        The grasp with a horizontal approach along the view; confidence 1 at a strip's end, at most 0.5 at an armhole.

    Raises:
        PerceptionFailure: the gown's neckline, or neither binding on that side, is seen.
    """
    points, labels = points_in_map(frame), surfaces(frame.rgb)
    valid = frame.depth > 0
    collar = points[(labels == Surface.COLLAR) & valid].reshape(-1, 3)
    if len(collar) < POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neckline of the hung gown")
    lateral = frame.pose_camera_in_map[:3, 0] * (1.0, 1.0, 0.0)
    lateral /= np.linalg.norm(lateral)
    top = float(np.percentile(collar[:, 2], 99))
    middle = float(np.median(points[np.isin(labels, GOWN_SURFACES) & valid] @ lateral))
    patch, sure = _of_side(collar[collar[:, 2] < top - STRIP], lateral, middle, side), 1.0
    if len(patch) and top - float(patch[:, 2].min()) > FALL:
        ends = patch[patch[:, 2] <= np.percentile(patch[:, 2], 12)]
    else:
        binding = points[(labels == Surface.ARMHOLE) & valid].reshape(-1, 3)
        patch, sure = _of_side(binding, lateral, middle, side), 0.5
        if not len(patch):
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"the {side} shoulder of the hung gown")
        ends = patch[patch[:, 2] >= np.percentile(patch[:, 2], 88)]
    position = np.median(ends, axis=0)
    view = (position - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0)
    approach = view / np.linalg.norm(view)
    return GraspPoint(stamp=frame.stamp, confidence=sure * float(min(1.0, len(patch) / 60)), target=SLEEVE_OF[side],
                      position_in_map=position, approach_in_map=approach,
                      closing_in_map=np.array((-approach[1], approach[0], 0.0)))


def _of_side(cloud: np.ndarray, lateral: np.ndarray, middle: float, side: Side) -> np.ndarray:
    """The patch (k, 3) of a binding on one side: of two large ones the left or right, of one by the gown's middle."""
    if len(cloud) < POINTS:
        return cloud[:0]
    labels = clusters(cloud, GAP)
    large = [cloud[labels == k] for k in range(min(3, int(labels.max()) + 1)) if (labels == k).sum() >= POINTS]
    if len(large) >= 2 and len(large[1]) > 0.12 * len(large[0]):
        first, second = sorted(large[:2], key=lambda patch: float(np.median(patch @ lateral)))
        return first if side == "right" else second
    wanted = -1.0 if side == "right" else 1.0
    if large and wanted * (float(np.median(large[0] @ lateral)) - middle) > 0.0:
        return large[0]
    return cloud[:0]

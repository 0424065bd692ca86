"""The hung gown's hook and the two corners of its neckline, where the navy binding ends at the shoulders.

The binding falls from the hook in two strips.  A strip that is seen down to its end, with the armhole beside it, shows
its corner.  Where one corner is drawn aside already, the other strip falls alone; if it hangs in a narrow fold, the
corner is where the fold opens below it, for there the binding ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..sim.world import Frame, Side
from .cloud import clusters, points_in_map, unit
from .colours import Surface
from .errors import PerceptionFailure, Problem
from .estimates import CORNER_OF, GraspPoint, GraspTarget
from .garment import gown_labels

NECKLINE = 0.84  # length of an adult gown's neckline that carries its weight, within 3 cm [m]
APART = 0.13  # from the hook the neckline has parted into two strips [m]
LENGTH = (0.21, 0.62)  # of a strip from the hook to its corner, through the air [m]
UNSURE = 0.08  # of that length, as the other strip tells it [m]
GAP = 0.025  # points of one strip lie nearer together than this [m]
POINTS = 25  # a smaller patch is noise
END = 0.045  # this much of a strip counts as its end [m]
NARROW = 0.03  # a strip of which less is seen hangs in a fold [m]
BESIDE = 0.10  # from a corner the armhole's binding is this near [m]
STRAP = 0.025  # from what is seen of an armhole up to the corner beside it [m]
LEAN = 0.28  # of a free edge in a fold towards the camera, for each metre that it falls [m]
INSIDE_EDGE = 0.003  # of the grasp, from both edges of a binding that shows [m]


@dataclass(frozen=True)
class Strip:
    """One strip of the neckline's binding, from the hook down.

    Attributes:
        corner_in_map: (3,) the end of its free edge [m].
        start_in_map: (3,) the first of it that is seen, below where the two strips part [m].
        tip_in_map: (3,) the last of it [m].
        along_in_map: (3,) unit vector down the strip.
        outward_in_map: (3,) unit vector from the fabric to the free edge.
        width: that is seen of its end [m].
        length: from the hook to the corner [m].
        armhole: share of what should be seen of the armhole's binding beside it, 0 to 1.
    """

    corner_in_map: np.ndarray
    start_in_map: np.ndarray
    tip_in_map: np.ndarray
    along_in_map: np.ndarray
    outward_in_map: np.ndarray
    width: float
    length: float
    armhole: float

    @property
    def clear(self) -> bool:
        """Whether its end is a corner."""
        return self.width > NARROW and self.armhole > 0.5 and LENGTH[0] < self.length < LENGTH[1]


def hook(frame: Frame) -> GraspPoint:
    """Where the gown hangs: the top of its neckline, as a place to grasp from the camera's side.

    Raises:
        PerceptionFailure: no neckline is seen.
    """
    seen = (gown_labels(frame) == Surface.COLLAR) & (frame.depth > 0)
    if seen.sum() < POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neckline of the hung gown")
    collar = points_in_map(frame)[seen]
    top = np.median(collar[collar[:, 2] > np.percentile(collar[:, 2], 98) - 0.015], axis=0)
    return _grasp(frame, top, "near_hang", 0.9)


def hung_corner(frame: Frame, side: Side, hook_in_map: np.ndarray | None = None,
                other_length: float | None = None) -> GraspPoint:
    """One corner of the neckline of a gown that hangs with its outside to the camera.

    Args:
        frame: of a camera that sees the gown's outside.
        side: the wearer's; seen from outside, the wearer's right is on the left of the picture.
        hook_in_map: (3,) where the gown hangs, if that is known already [m].
        other_length: from the hook to the other corner, if that is held aside already [m].

    Returns:
        The grasp, just inside both edges of the binding, with a horizontal approach along the view.

    Raises:
        PerceptionFailure: the corner is not seen.
    """
    top = hook(frame).position_in_map if hook_in_map is None else np.asarray(hook_in_map, float)
    found = strips(frame, top)
    sideways = (1.0 if side == "left" else -1.0) * frame.pose_camera_in_map[:3, 0]
    clear = [strip for strip in found if strip.clear]
    if other_length is not None:
        length = NECKLINE - other_length
        clear = [strip for strip in found if strip.armhole > 0.5 and abs(strip.length - length) < UNSURE]
        if not clear:
            return _grasp(frame, _in_fold(frame, found, top, length), CORNER_OF[side], 0.4)
    elif len(clear) < 2:  # which of them it is, its side of the hook must tell
        clear = [strip for strip in clear if (strip.corner_in_map - top) @ sideways > 0.03]
    if not clear:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"the {side} corner of the hung gown's neckline")
    best = max(clear, key=lambda strip: float(strip.corner_in_map @ sideways))
    margin = INSIDE_EDGE if best.width > NARROW else -INSIDE_EDGE  # what lies behind a fold's edge is not to be taken
    position = best.corner_in_map - margin * (best.outward_in_map + best.along_in_map)
    return _grasp(frame, position, CORNER_OF[side], min(1.0, best.width / 0.045))


def strips(frame: Frame, top: np.ndarray) -> list[Strip]:
    """The strips that fall from the hook at `top` (3,), the largest first."""
    labels, cloud = gown_labels(frame), points_in_map(frame)
    seen = frame.depth > 0
    collar = cloud[(labels == Surface.COLLAR) & seen]
    armhole = cloud[(labels == Surface.ARMHOLE) & seen]
    fabric = cloud[np.isin(labels, (Surface.OUTSIDE, Surface.INSIDE)) & seen]
    offset = collar - top
    lower = collar[(np.linalg.norm(offset, axis=1) > APART) & (offset[:, 2] < -0.06)]
    if len(lower) < POINTS:
        return []
    patch = clusters(lower, GAP)
    sizes = np.bincount(patch)
    return [_strip(lower[patch == k], fabric, armhole, top) for k in np.flatnonzero(sizes >= POINTS)]


def _strip(points: np.ndarray, fabric: np.ndarray, armhole: np.ndarray, top: np.ndarray) -> Strip:
    far = np.linalg.norm(points - top, axis=1)
    along = unit(np.median(points[far > far.max() - END], axis=0) - np.median(points[far < far.min() + END], axis=0))
    if far.max() - far.min() < 2 * END:  # short: it falls from the hook
        along = unit(points.mean(axis=0) - top)
    run = (points - top) @ along
    end = points[run > run.max() - END]
    middle = end.mean(axis=0)
    across = end - middle
    across -= np.outer(across @ along, along)
    outward = np.linalg.svd(across, full_matrices=False)[2][0]
    near = fabric[np.linalg.norm(fabric - middle, axis=1) < 0.07] - middle
    near = near[near @ along < 0.0] @ outward
    if len(near) and np.median(np.sign(near)) > 0.0:
        outward = -outward
    spread = across @ outward
    low, high = np.percentile(spread, (3, 97))
    corner = middle + high * outward + (float(np.percentile(run, 99)) - float((middle - top) @ along)) * along
    beside = int((np.linalg.norm(armhole - corner, axis=1) < BESIDE).sum())
    tip = np.median(points[run > run.max() - 0.015], axis=0)
    return Strip(corner, np.median(points[far < far.min() + 0.02], axis=0), tip, along, outward, float(high - low), float(np.linalg.norm(corner - top)),
                 min(1.0, beside / 12))


def _in_fold(frame: Frame, found: list[Strip], top: np.ndarray, length: float) -> np.ndarray:
    """Where a strip ends (3,) that is seen only at its upper part: where the armhole begins below it, or by its length.

    Raises:
        PerceptionFailure: no strip falls below the hook.
    """
    sideways = frame.pose_camera_in_map[:3, 0]
    below = [strip for strip in found if abs((strip.tip_in_map - top) @ sideways) < 0.6 * strip.length]
    if not below:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "second strip of the hung gown's neckline")
    tip = max(below, key=lambda each: each.length).tip_in_map
    level = min(top[2] - np.sqrt(max(length**2 - float(((tip - top)[:2] ** 2).sum()), 0.04)), tip[2])
    labels, cloud = gown_labels(frame), points_in_map(frame)
    seen = (frame.depth > 0) & (np.abs((cloud - tip) @ sideways) < 0.04) & (np.abs(cloud[..., 2] - level) < UNSURE)
    seen &= np.linalg.norm((cloud - tip)[..., :2], axis=2) < 0.15
    armhole = cloud[seen & (labels == Surface.ARMHOLE)]
    if len(armhole) >= 4:
        level = float(np.percentile(armhole[:, 2], 95)) + STRAP
    ahead = np.cross((0.0, 0.0, 1.0), sideways)
    lean = -LEAN * (top[2] - level) - (tip - top) @ ahead
    return np.array((*(tip + lean * ahead)[:2], level))


def _grasp(frame: Frame, position: np.ndarray, target: GraspTarget, confidence: float) -> GraspPoint:
    approach = unit((position - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0))
    return GraspPoint(stamp=frame.stamp, confidence=confidence, target=target, position_in_map=position,
                      approach_in_map=approach, closing_in_map=np.array((-approach[1], approach[0], 0.0)))

"""The hung gown's hook and the two corners of its neckline, where the navy binding ends at the shoulders.

The binding falls from the hook in two strips.  A strip that is seen down to its end, with the armhole beside it, shows
its corner.  Where one corner is drawn aside already, the other strip falls alone; if it hangs in a narrow fold, the
corner is where the fold opens below it, for there the binding ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..sim.world import Frame, Side
from .cloud import clusters, points_in_map, project, unit
from .colours import Surface
from .errors import PerceptionFailure, Problem
from .estimates import CORNER_OF, GraspPoint, GraspTarget
from .garment import gown_labels

NECKLINE = 0.84  # length of an adult gown's neckline that carries its weight, within 3 cm [m]
APART = 0.13  # from the hook the neckline has parted into two strips [m]
LENGTH = (0.21, 0.62)  # of a strip from the hook to its corner, through the air [m]
HUNG = 0.80  # both strips together where they hang, within 4 cm [m]
UNSURE = 0.085  # of that length, as the other strip tells it [m]
SEWN = 0.015  # fabric this near to a strip is sewn to it [m]
TELLS = 0.1  # how clearly that must say which strip it is
SAME = 0.08  # a corner that is seen again within this distance is the same one [m]
DRAWN = 0.20  # sideways of the hook, what hangs farther out belongs to the strip that is drawn aside [m]
BLUNT = 0.75  # a strip that ends at its corner keeps this much of its width to the last
ASIDE = 0.03  # of the hook, where a strip that does not tell what it is belongs to that side [m]
GAP = 0.025  # points of one strip lie nearer together than this [m]
POINTS = 25  # a smaller patch is noise
END = 0.045  # this much of a strip counts as its end [m]
NARROW = 0.03  # a strip of which less is seen hangs in a fold [m]
BESIDE = 0.10  # from a corner the armhole's binding is this near [m]
STRAP = 0.025  # from what is seen of an armhole up to the corner beside it [m]
LEAN = 0.28  # of a free edge in a fold towards the camera, for each metre that it falls [m]
INSIDE_EDGE = 0.003  # of the grasp, from both edges of a binding that shows [m]


@dataclass(frozen=True, eq=False)
class Strip:
    """One strip of the neckline's binding, from the hook down.

    Attributes:
        corner_in_map: (3,) the end of its free edge [m].
        tip_in_map: (3,) the last of it that is seen [m].
        along_in_map: (3,) unit vector down the strip.
        outward_in_map: (3,) unit vector from the fabric to the free edge.
        width: that is seen of its end [m].
        length: from the hook to the corner [m].
        armhole: share of what should be seen of the armhole's binding beside it, 0 to 1.
        tells: from -1, the wearer's left strip, to 1, the right one.
        blunt: width of the last of it, as a share of `width`: a fold that closes cuts a strip to a point.
    """

    corner_in_map: np.ndarray
    tip_in_map: np.ndarray
    along_in_map: np.ndarray
    outward_in_map: np.ndarray
    width: float
    length: float
    armhole: float
    tells: float
    blunt: float


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
                other_length: float | None = None, near_in_map: np.ndarray | None = None) -> GraspPoint:
    """One corner of the neckline of a gown that hangs with its outside to the camera.

    Args:
        frame: of a camera that sees the gown's outside.
        side: the wearer's; seen from outside, the wearer's right is on the left of the picture.
        hook_in_map: (3,) where the gown hangs, if that is known already [m].
        other_length: from the hook to the other corner, if that is held aside already [m].
        near_in_map: (3,) where the corner was just now; one that is farther away than 8 cm is another [m].

    Returns:
        The grasp, just inside both edges of the binding, with a horizontal approach along the view.

    Raises:
        PerceptionFailure: the corner is not seen.
    """
    top = hook(frame).position_in_map if hook_in_map is None else np.asarray(hook_in_map, float)
    sign = 1.0 if side == "right" else -1.0
    found = strips(frame, top)
    length = LENGTH[1] if other_length is None else NECKLINE - other_length
    fits = [strip for strip in found if LENGTH[0] < strip.length < length + UNSURE]
    if near_in_map is not None:
        fits = [strip for strip in found if np.linalg.norm(strip.corner_in_map - near_in_map) < SAME]
    elif other_length is None:
        fits = _first(frame, fits, top, sign)
    else:  # the other strip is drawn aside, to its own side
        sideways = sign * frame.pose_camera_in_map[:3, 0]
        fits = [strip for strip in fits if (strip.corner_in_map - top) @ sideways < DRAWN]
        fits = [strip for strip in fits if strip.armhole > 0.5
                or (strip.blunt > BLUNT and strip.width > 0.4 * NARROW and abs(strip.length - length) < UNSURE)]
        if not fits:
            return _grasp(frame, _in_fold(frame, found, top, length), CORNER_OF[side], 0.4)
    if not fits:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"the {side} corner of the hung gown's neckline")
    best = max(fits, key=lambda strip: strip.length)
    margin = INSIDE_EDGE if best.width > NARROW else -INSIDE_EDGE  # what lies behind a fold's edge is not to be taken
    position = best.corner_in_map - margin * (best.outward_in_map + best.along_in_map)
    confidence = min(1.0, best.width / 0.045) * (0.5 + 0.5 * best.armhole)
    return _grasp(frame, position, CORNER_OF[side], confidence)


def _first(frame: Frame, found: list[Strip], top: np.ndarray, sign: float) -> list[Strip]:
    """Strips that may lead to one corner while both hang: by what tells them, and by the length of the other.

    Args:
        frame: where they were found.
        found: all of them.
        top: (3,) of the hook [m].
        sign: -1 for the wearer's left corner, 1 for the right one.
    """
    sideways = -sign * frame.pose_camera_in_map[:3, 0]
    fits = [strip for strip in found if sign * strip.tells > TELLS
            or (abs(strip.tells) <= TELLS and (strip.corner_in_map - top) @ sideways > ASIDE)]
    others = [strip for strip in found if sign * strip.tells < -0.3 and strip.armhole > 0.5 and strip.width > NARROW]
    if others:  # a strip that is as long as the other one leaves is better than one that a fold cuts short
        left = HUNG - max(strip.length for strip in others)
        whole = [strip for strip in found if strip not in others and abs(strip.length - left) < UNSURE]
        return whole or fits
    return fits


def strips(frame: Frame, top: np.ndarray) -> list[Strip]:
    """The strips that fall from the hook at `top` (3,), the largest first."""
    labels, cloud = gown_labels(frame), points_in_map(frame)
    seen = frame.depth > 0
    armhole = cloud[(labels == Surface.ARMHOLE) & seen]
    fabric = _Pixels(frame, np.isin(labels, (Surface.OUTSIDE, Surface.INSIDE)) & seen, cloud)
    outside = labels[fabric.rows, fabric.columns] == Surface.OUTSIDE
    with np.errstate(invalid="ignore"):
        lower = (labels == Surface.COLLAR) & seen & (cloud[..., 2] < top[2] - 0.06)
        lower &= np.linalg.norm(cloud - top, axis=2) > APART
    collar = _Pixels(frame, lower, cloud)
    if len(collar.points) < POINTS:
        return []
    patch = clusters(collar.points, GAP)
    found = []
    for k in np.flatnonzero(np.bincount(patch) >= POINTS):
        mine = collar.only(patch == k)
        found.append(_strip(mine, fabric, outside, armhole, top))
    return found


class _Pixels:
    """Pixels with their points: `rows`, `columns` (n,) and `points` (n, 3)."""

    def __init__(self, frame: Frame, mask: np.ndarray, cloud: np.ndarray) -> None:
        self.frame = frame
        self.rows, self.columns = np.nonzero(mask)
        self.points = cloud[self.rows, self.columns]

    def only(self, chosen: np.ndarray) -> _Pixels:
        """Some of them."""
        some = object.__new__(_Pixels)
        some.frame, some.rows, some.columns = self.frame, self.rows[chosen], self.columns[chosen]
        some.points = self.points[chosen]
        return some


def _strip(collar: _Pixels, fabric: _Pixels, outside: np.ndarray, armhole: np.ndarray, top: np.ndarray) -> Strip:
    points = collar.points
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
    near = fabric.points[np.linalg.norm(fabric.points - middle, axis=1) < 0.07] - middle
    near = near[near @ along < 0.0] @ outward
    if len(near) and np.median(np.sign(near)) > 0.0:
        outward = -outward
    spread = across @ outward
    low, high = np.percentile(spread, (3, 97))
    corner = middle + high * outward + (float(np.percentile(run, 99)) - float((middle - top) @ along)) * along
    beside = int((np.linalg.norm(armhole - corner, axis=1) < BESIDE).sum())
    last = points[run > run.max() - 0.015]
    blunt = float(np.ptp(last @ outward)) / max(float(high - low), 1e-3)
    return Strip(corner, np.median(last, axis=0), along, outward, float(high - low),
                 float(np.linalg.norm(corner - top)), min(1.0, beside / 12), _side(collar, fabric, outside, far), blunt)


def _side(collar: _Pixels, fabric: _Pixels, outside: np.ndarray, far: np.ndarray) -> float:
    """Which strip it is, by the fabric that is sewn to it: see `Strip.tells`.

    Seen from outside, the fabric lies to the left of the wearer's left strip on its way down (clockwise from it), and
    to the right of the right one; where the inside shows, the two are swapped.
    """
    from scipy.spatial import KDTree

    found = KDTree(collar.points).query(fabric.points, distance_upper_bound=SEWN)
    gap, nearest = np.asarray(found[0]), np.asarray(found[1])
    sewn = np.isfinite(gap)
    ends = [np.median(collar.points[part], axis=0) for part in (far < far.min() + 0.03, far > far.max() - 0.03)]
    down = np.diff(project(collar.frame, np.stack(ends))[:, :2], axis=0)[0]
    if sewn.sum() < 10 or np.linalg.norm(down) < 4.0:
        return 0.0
    away = np.column_stack((fabric.columns[sewn] - collar.columns[nearest[sewn]],
                            fabric.rows[sewn] - collar.rows[nearest[sewn]]))
    clockwise = down[0] * away[:, 1] - down[1] * away[:, 0]  # rows grow downwards
    return float(-np.mean(np.sign(clockwise) * np.where(outside[sewn], 1.0, -1.0)))


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

"""The hung gown's hook and the two corners of its neckline, where the navy binding ends at the shoulders.

The binding falls from the hook in two strips.  A strip that is seen down to its end, flat to the camera, shows its
corner to within a centimetre; from one of three places about the rail at least one does.  Where that one is drawn aside
already, the other strip falls alone; if it hangs in a narrow fold, the corner is where the fold opens below it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import CORNER_OF, GraspPoint, GraspTarget
from ..image.cloud import clusters, points_in_map, project, unit
from ..image.garment import gown_labels
from ..image.surfaces import GOWN_SURFACES, Surface

NECKLINE = 0.84  # length of an adult gown's neckline that carries its weight, within 3 cm [m]
APART = 0.13  # from the hook the neckline has parted into two strips [m]
LENGTH = (0.21, 0.62)  # of a strip from the hook to its corner, through the air [m]
HUNG = 0.80  # both strips together where they hang, within 4 cm [m]
UNSURE = 0.085  # of that length, as the other strip tells it [m]
SEWN = 0.015  # fabric this near to a strip is sewn to it [m]
TELLS = 0.6  # how clearly that must say which strip it is
SAME = 0.08  # a corner that is seen again within this distance is the same one [m]
DRAWN = 0.20  # sideways of the hook, what hangs farther out belongs to the strip that is drawn aside [m]
BLUNT = 0.75  # a strip that ends at its corner keeps this much of its width to the last
GAPS = (0.013, 0.009)  # points of one strip lie nearer together; the less, the better crossing strips part [m]
POINTS = 25  # a smaller patch is noise
END = 0.045  # this much of a strip counts as its end [m]
NARROW = 0.03  # a strip of which less is seen hangs in a fold [m]
BESIDE = 0.10  # from a corner the armhole's binding is this near [m]
STRAP = 0.025  # from what is seen of an armhole up to the corner beside it [m]
LEAN = 0.28  # of a free edge in a fold towards the camera, for each metre that it falls [m]
FLAT, WHOLE, HIDDEN = 0.043, 0.85, 0.15  # width [m], bluntness and cut of a strip that shows its end
BEFORE = 0.02  # nearer to the camera than this is before it, not beside it [m]
CLEAR, WIDE = 0.04, 0.07  # round a corner without other cloth, and where its own sheet is followed [m]
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
        cut: share of what is seen just beyond its end that lies nearer to the camera: the strip goes on behind that.
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
    cut: float

    @property
    def shows(self) -> bool:
        """Whether it is seen down to its end, flat to the camera."""
        return self.width > FLAT and self.blunt > WHOLE and self.cut < HIDDEN


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


def shown_corner(frame: Frame, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
    """The corner of a hung gown's neckline that shows best; the target tells which one it is.

    Only a strip that is seen down to its end, flat to the camera, with its fabric beside it, counts.  Of two the one
    that hangs clear of other cloth is chosen, or else the higher one: nothing hangs in front of it.

    Args:
        frame: of a camera that sees the gown's outside.
        hook_in_map: (3,) where the gown hangs [m].
        side: the wearer's, if only that one is wanted.

    Returns:
        The grasp, just inside both edges of the binding, with a horizontal approach along the view.  Its confidence is
        below 0.5 where other cloth hangs so near that the fingers might take it too.

    Raises:
        PerceptionFailure: neither shows.
    """
    wanted = {None: 0.0, "left": -1.0, "right": 1.0}[side]
    told = [
        strip
        for strip in strips(frame, hook_in_map)
        if strip.shows
        and abs(strip.tells) > TELLS
        and LENGTH[0] < strip.length < LENGTH[1]
        and strip.tells * wanted >= 0.0
    ]
    if not told:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "a corner of the hung gown's neckline")
    crowded = {id(strip): _crowded(frame, strip.corner_in_map) for strip in told}
    best = min(told, key=lambda strip: (crowded[id(strip)], strip.length))
    target = CORNER_OF["right" if best.tells > 0.0 else "left"]
    return _grasp(frame, _inside(best), target, abs(best.tells) * (0.4 if crowded[id(best)] else 1.0))


def _crowded(frame: Frame, corner: np.ndarray) -> bool:
    """Whether cloth that is not the corner's own sheet is seen beside a corner (3,)."""
    cloud = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
    away = np.linalg.norm(cloud - corner, axis=1)
    near, away = cloud[away < WIDE], away[away < WIDE]
    if len(near) == 0:
        return False
    sheet = clusters(near, GAPS[0])
    return int(((sheet != sheet[np.argmin(away)]) & (away < CLEAR)).sum()) >= POINTS // 2


def hung_corner(
    frame: Frame,
    side: Side,
    hook_in_map: np.ndarray,
    other_length: float | None = None,
    near_in_map: np.ndarray | None = None,
) -> GraspPoint:
    """One corner of a hung gown's neckline: one that was seen just now, or the second one.

    Args:
        frame: of a camera that sees the gown's outside.
        side: the wearer's; seen from outside, the wearer's right is on the left of the picture.
        hook_in_map: (3,) where the gown hangs [m].
        other_length: from the hook to the other corner, if that is held aside already [m].
        near_in_map: (3,) where the corner was just now; one that is farther away than 8 cm is another [m].

    Returns:
        The grasp, just inside both edges of the binding, with a horizontal approach along the view.  Below a confidence
        of 0.5 it is inferred from what hangs there, or other cloth hangs beside it while the first one is looked for.

    Raises:
        PerceptionFailure: the corner is not seen.
    """
    top = np.asarray(hook_in_map, float)
    found = strips(frame, top)
    if near_in_map is not None:
        fits = [strip for strip in found if np.linalg.norm(strip.corner_in_map - near_in_map) < SAME]
        fits.sort(key=lambda strip: (not strip.shows, np.linalg.norm(strip.corner_in_map - near_in_map)))
    else:  # the other strip is drawn aside, to its own side
        length = HUNG / 2 if other_length is None else NECKLINE - other_length
        sideways = (1.0 if side == "right" else -1.0) * frame.pose_camera_in_map[:3, 0]
        fits = [
            strip
            for strip in found
            if LENGTH[0] < strip.length < LENGTH[1] + UNSURE and (strip.corner_in_map - top) @ sideways < DRAWN
        ]
        fits = [
            strip
            for strip in fits
            if strip.shows
            or (
                strip.length < length + UNSURE
                and (
                    strip.armhole > 0.5
                    or (strip.blunt > BLUNT and strip.width > 0.4 * NARROW and abs(strip.length - length) < UNSURE)
                )
            )
        ]
        fits.sort(key=lambda strip: (not strip.shows, -strip.length))
        if not fits:
            return _grasp(frame, _in_fold(frame, found, top, length), CORNER_OF[side], 0.4)
    if not fits:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"the {side} corner of the hung gown's neckline")
    best = fits[0]
    confidence = 0.9 if best.shows else 0.5 + 0.3 * min(1.0, best.width / FLAT) * best.armhole
    if other_length is None and _crowded(frame, best.corner_in_map):
        confidence *= 0.4
    return _grasp(frame, _inside(best), CORNER_OF[side], confidence)


def _inside(strip: Strip) -> np.ndarray:
    """Where to take a strip (3,): what lies behind a fold's edge is not to be taken with it."""
    margin = INSIDE_EDGE if strip.width > NARROW else -INSIDE_EDGE
    return strip.corner_in_map - margin * (strip.outward_in_map + strip.along_in_map)


def strips(frame: Frame, top: np.ndarray) -> list[Strip]:
    """The strips that fall from the hook at `top` (3,), as they part at either of two gaps."""
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
    found = []
    for gap in GAPS:
        patch = clusters(collar.points, gap)
        for k in np.flatnonzero(np.bincount(patch) >= POINTS):
            found.append(_strip(collar.only(patch == k), fabric, outside, armhole, top))
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
    return Strip(
        corner,
        np.median(last, axis=0),
        along,
        outward,
        float(high - low),
        float(np.linalg.norm(corner - top)),
        min(1.0, beside / 12),
        _side(collar, fabric, outside, far),
        blunt,
        _cut(collar.frame, middle, along, outward, 0.4 * float(high - low)),
    )


def _cut(frame: Frame, end: np.ndarray, along: np.ndarray, outward: np.ndarray, half: float) -> float:
    """Share of the places just beyond the end (3,) of a strip where something nearer to the camera is seen."""
    places = np.array(
        [
            end + (0.5 * END + step) * along + side * half * outward
            for step in (0.005, 0.015, 0.025)
            for side in (-1.0, 0.0, 1.0)
        ]
    )
    u, v, z = project(frame, places).T
    height, width = frame.depth.shape
    column, row = np.clip(np.rint(u).astype(int), 0, width - 1), np.clip(np.rint(v).astype(int), 0, height - 1)
    there = frame.depth[row, column]
    return float(np.mean((there > 0) & (there < z - BEFORE)))


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
    away = np.column_stack(
        (fabric.columns[sewn] - collar.columns[nearest[sewn]], fabric.rows[sewn] - collar.rows[nearest[sewn]])
    )
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
    return GraspPoint(
        stamp=frame.stamp,
        confidence=confidence,
        target=target,
        position_in_map=position,
        approach_in_map=approach,
        closing_in_map=np.array((-approach[1], approach[0], 0.0)),
    )

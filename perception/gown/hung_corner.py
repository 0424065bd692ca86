"""The hung gown's hook and the two corners of its neckline, where the navy tape ends at the shoulders.

The tape falls from the hook in two strips.  A strip that is seen flat to the camera and down to its end shows its
corner to within a centimetre.  From one of three places about the rail at least one strip is seen like that.  Once that
one is drawn aside, the other strip hangs alone; if it hangs in a narrow fold, its corner is where the fold opens below.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import CORNER_OF, GraspPoint, GraspTarget
from ..image.cloud import clusters, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map, project
from ..image.surfaces import GOWN_SURFACES, Surface
from .gown_facts import GOWN


@dataclass(frozen=True, kw_only=True)
class HungCornerTuning(Quantities):
    """Numbers of the search for the hook and the corners of a hung gown."""

    # which pixels belong to a strip
    min_points: int = quantity(25, "1", "of a patch of tape", "choice: a smaller patch is noise")
    parting_distance: float = quantity(
        0.13,
        "m",
        "from the hook, beyond which the neckline has parted into two strips",
        "choice: by trial, not recorded",
    )
    parting_drop: float = quantity(0.06, "m", "below the hook, the same", "choice: by trial, not recorded")
    max_steps: tuple[float, float] = quantity(
        (0.013, 0.009), "m", "between points of one strip", "choice: both are tried; the less, the better strips part"
    )
    # how a strip lies
    length_range: tuple[float, float] = quantity(
        (0.21, 0.62), "m", "from the hook to a corner, through the air", "choice: by trial, not recorded"
    )
    length_tolerance: float = quantity(
        0.085, "m", "of the length that the other strip leaves for this one", "choice: by trial, not recorded"
    )
    end_length: float = quantity(0.045, "m", "of a strip that is its end", "choice: somewhat less than its width")
    last_length: float = quantity(0.015, "m", "of a strip that is the last of it", "choice: a third of its end")
    side_length: float = quantity(0.03, "m", "of a strip at either end that gives its direction", "choice: steady")
    fabric_distance: float = quantity(
        0.07, "m", "from a strip's end, within which fabric tells the free edge", "choice: more than the tape's width"
    )
    sewn_distance: float = quantity(
        0.015, "m", "from a strip, within which fabric is sewn to it", "choice: one or two pixels of the head camera"
    )
    min_sewn_points: int = quantity(10, "1", "of sewn fabric that tell the side", "choice: fewer are noise")
    min_strip_pixels: float = quantity(4.0, "px", "of a strip's length that tell the side", "choice: less is noise")
    armhole_distance: float = quantity(
        0.10, "m", "from a corner to the tape of the armhole beside it, at most", "choice: by trial, not recorded"
    )
    full_armhole_points: int = quantity(12, "1", "of that tape, from which all of it shows", "choice: clear of noise")
    # what hides a strip's end
    front_margin: float = quantity(
        0.02, "m", "nearer to the camera than this is before a thing, not beside it", "choice: above depth noise"
    )
    beyond_steps: tuple[float, float, float] = quantity(
        (0.005, 0.015, 0.025), "m", "beyond a strip's end, where something before it is looked for", "choice: evenly"
    )
    beyond_width: float = quantity(0.4, "1", "of the strip's width, to either side, the same", "choice: inside of it")
    # what makes a corner certain
    min_width: float = quantity(0.043, "m", "of a strip flat to the camera", "choice: of a tape of 0.055 m")
    min_bluntness: float = quantity(0.85, "1", "of a strip that is seen to its end", "choice: by trial, not recorded")
    max_cut: float = quantity(0.15, "1", "of a strip that is seen to its end", "choice: one of nine places is noise")
    min_side_share: float = quantity(0.6, "1", "of sewn fabric that must agree on the side", "choice: four of five")
    # corners that are inferred
    same_distance: float = quantity(
        0.08, "m", "from where it was just now, within which a corner is the same one", "choice: it swings less"
    )
    drawn_distance: float = quantity(
        0.20,
        "m",
        "sideways of the hook, beyond which the strip is the one drawn aside",
        "choice: by trial, not recorded",
    )
    fold_bluntness: float = quantity(
        0.75, "1", "of a strip in a fold that ends at its corner", "choice: less than of one that shows"
    )
    fold_width: float = quantity(0.03, "m", "of a strip of which less is seen in a fold", "choice: half the tape")
    min_fold_width_share: float = quantity(0.4, "1", "of that width that must be seen", "choice: a few pixels")
    min_armhole_share: float = quantity(0.5, "1", "of the armhole's tape that confirms a corner", "choice: half of it")
    below_hook: float = quantity(
        0.6, "1", "of its length, that a strip in a fold lies aside at most", "choice: the other one is drawn farther"
    )
    min_fall_squared: float = quantity(0.04, "m^2", "of a strip in a fold", "choice: it hangs 0.2 m at least")
    fold_distance: tuple[float, float] = quantity(
        (0.04, 0.15), "m", "of the armhole from a strip's tip: in the picture, level", "choice: by trial, not recorded"
    )
    min_fold_points: int = quantity(4, "1", "of an armhole in a fold", "choice: fewer are noise")
    armhole_to_corner: float = quantity(
        0.025, "m", "from the highest of an armhole that is seen up to the corner", "choice: by trial, not recorded"
    )
    fold_lean: float = quantity(
        0.28, "1", "of a free edge in a fold towards the camera, for its fall", "choice: by trial, not recorded"
    )
    # where it is taken
    clear_distance: float = quantity(0.04, "m", "round a corner without other cloth", "choice: what fingers would take")
    sheet_distance: float = quantity(0.07, "m", "within which the corner's own sheet is followed", "choice: wider")
    inset: float = quantity(
        0.003, "m", "of the grasp from both edges of a tape that shows", "choice: the corner, and little else"
    )
    hook_percentile: float = quantity(98.0, "%", "of the tape's heights that is the top", "choice: leaves noise out")
    hook_depth: float = quantity(0.015, "m", "below that height, of the tape at the hook", "choice: a few pixels")
    # confidence
    shown_confidence: float = quantity(0.9, "1", "in the hook, and in a corner that shows", "choice: nearly certain")
    seen_confidence: tuple[float, float] = quantity(
        (0.5, 0.3), "1", "in a corner seen in part: at least, and more by what shows", "choice: above an inferred one"
    )
    inferred_confidence: float = quantity(0.4, "1", "in a corner in a fold", "choice: below 0.5, which means seen")
    crowded_factor: float = quantity(0.4, "1", "of confidence beside other cloth", "choice: takes it below 0.5")


DEFAULT = HungCornerTuning()


@dataclass(frozen=True, eq=False)
class Strip:
    """One strip of the neckline's tape, from the hook down.

    Attributes:
        corner_in_map: (3,) the end of its free edge [m].
        tip_in_map: (3,) the last of it that is seen [m].
        along_in_map: (3,) unit vector down the strip.
        outward_in_map: (3,) unit vector from the fabric to the free edge.
        width: that is seen of its end [m].
        length: from the hook to the corner [m].
        armhole: share of what should be seen of the armhole's tape beside it, 0 to 1.
        tells: from -1, the wearer's left strip, to 1, the right one.
        blunt: width of the last of it, as a share of `width`: a fold that closes cuts a strip to a point.
        cut: share of what is seen just beyond its end that lies nearer to the camera: the strip goes on behind that.
        shows: whether it is seen down to its end, flat to the camera.
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
    shows: bool


def hook(frame: Frame, tuning: HungCornerTuning = DEFAULT) -> GraspPoint:
    """Where the gown hangs: the top of its neckline, as a place to grasp from the camera's side.

    Raises:
        PerceptionFailure: no neckline is seen.
    """
    seen = (gown_labels(frame) == Surface.COLLAR) & (frame.depth > 0)
    if seen.sum() < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neckline of the hung gown")
    collar = points_in_map(frame)[seen]
    lowest = np.percentile(collar[:, 2], tuning.hook_percentile) - tuning.hook_depth
    top = np.median(collar[collar[:, 2] > lowest], axis=0)
    return _grasp(frame, top, "near_hang", tuning.shown_confidence)


def shown_corner(
    frame: Frame, hook_in_map: np.ndarray, side: Side | None = None, tuning: HungCornerTuning = DEFAULT
) -> GraspPoint:
    """The corner of a hung gown's neckline that shows best; the target tells which one it is.

    Only a strip counts that is seen down to its end, flat to the camera, and whose fabric tells the side.  Of two the
    one that hangs clear of other cloth is chosen, or else the higher one: nothing hangs in front of it.

    Args:
        frame: of a camera that sees the gown's outside.
        hook_in_map: (3,) where the gown hangs [m].
        side: the wearer's, if only that one is wanted.
        tuning: numbers of the search.

    Returns:
        The grasp, just inside both edges of the tape, with a horizontal approach along the view.  Its confidence is
        below 0.5 where other cloth hangs so near that the fingers might take it too.

    Raises:
        PerceptionFailure: neither shows.
    """
    wanted = {None: 0.0, "left": -1.0, "right": 1.0}[side]
    told = [
        strip
        for strip in strips(frame, hook_in_map, tuning)
        if strip.shows
        and abs(strip.tells) > tuning.min_side_share
        and tuning.length_range[0] < strip.length < tuning.length_range[1]
        and strip.tells * wanted >= 0.0
    ]
    if not told:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "a corner of the hung gown's neckline")
    crowded = {id(strip): _crowded(frame, strip.corner_in_map, tuning) for strip in told}
    best = min(told, key=lambda strip: (crowded[id(strip)], strip.length))
    target = CORNER_OF["right" if best.tells > 0.0 else "left"]
    confidence = abs(best.tells) * (tuning.crowded_factor if crowded[id(best)] else 1.0)
    return _grasp(frame, _inside(best, tuning), target, confidence)


def _crowded(frame: Frame, corner: np.ndarray, tuning: HungCornerTuning) -> bool:
    """Whether cloth that is not the corner's own sheet is seen beside a corner (3,)."""
    cloud = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
    away = np.linalg.norm(cloud - corner, axis=1)
    near, away = cloud[away < tuning.sheet_distance], away[away < tuning.sheet_distance]
    if len(near) == 0:
        return False
    sheet = clusters(near, tuning.max_steps[0])
    other = (sheet != sheet[np.argmin(away)]) & (away < tuning.clear_distance)
    return int(other.sum()) >= tuning.min_points // 2


def hung_corner(
    frame: Frame,
    side: Side,
    hook_in_map: np.ndarray,
    other_length: float | None = None,
    near_in_map: np.ndarray | None = None,
    tuning: HungCornerTuning = DEFAULT,
) -> GraspPoint:
    """One corner of a hung gown's neckline: one that was seen just now, or the second one.

    Args:
        frame: of a camera that sees the gown's outside.
        side: the wearer's; seen from outside, the wearer's right is on the left of the picture.
        hook_in_map: (3,) where the gown hangs [m].
        other_length: from the hook to the other corner, if that is held aside already [m].
        near_in_map: (3,) where the corner was just now; one that is farther away than 8 cm is another [m].
        tuning: numbers of the search.

    Returns:
        The grasp, just inside both edges of the tape, with a horizontal approach along the view.  Below a confidence
        of 0.5 it is inferred from what hangs there, or other cloth hangs beside it while the first one is looked for.

    Raises:
        PerceptionFailure: the corner is not seen.
    """
    top = np.asarray(hook_in_map, float)
    found = strips(frame, top, tuning)
    if near_in_map is not None:
        near = np.asarray(near_in_map, float)
        fits = [strip for strip in found if np.linalg.norm(strip.corner_in_map - near) < tuning.same_distance]
        fits.sort(key=lambda strip: (not strip.shows, np.linalg.norm(strip.corner_in_map - near)))
    else:  # the other strip is drawn aside, to its own side
        length = GOWN.hung_neckline_length / 2 if other_length is None else GOWN.neckline_length - other_length
        sideways = (1.0 if side == "right" else -1.0) * frame.pose_camera_in_map[:3, 0]
        shortest, longest = tuning.length_range
        fits = [
            strip
            for strip in found
            if shortest < strip.length < longest + tuning.length_tolerance
            and (strip.corner_in_map - top) @ sideways < tuning.drawn_distance
        ]
        fits = [strip for strip in fits if strip.shows or _ends_at_corner(strip, length, tuning)]
        fits.sort(key=lambda strip: (not strip.shows, -strip.length))
        if not fits:
            return _grasp(
                frame, _in_fold(frame, found, top, length, tuning), CORNER_OF[side], tuning.inferred_confidence
            )
    if not fits:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"the {side} corner of the hung gown's neckline")
    best = fits[0]
    least, more = tuning.seen_confidence
    confidence = least + more * min(1.0, best.width / tuning.min_width) * best.armhole
    if best.shows:
        confidence = tuning.shown_confidence
    if other_length is None and _crowded(frame, best.corner_in_map, tuning):
        confidence *= tuning.crowded_factor
    return _grasp(frame, _inside(best, tuning), CORNER_OF[side], confidence)


def _ends_at_corner(strip: Strip, length: float, tuning: HungCornerTuning) -> bool:
    """Whether a strip that does not show well still ends at its corner: by its armhole, or by its `length` [m]."""
    if strip.length >= length + tuning.length_tolerance:
        return False
    if strip.armhole > tuning.min_armhole_share:
        return True
    wide = strip.width > tuning.min_fold_width_share * tuning.fold_width
    return wide and strip.blunt > tuning.fold_bluntness and abs(strip.length - length) < tuning.length_tolerance


def _inside(strip: Strip, tuning: HungCornerTuning) -> np.ndarray:
    """Where to take a strip (3,): what lies behind a fold's edge is not to be taken with it."""
    margin = tuning.inset if strip.width > tuning.fold_width else -tuning.inset
    return strip.corner_in_map - margin * (strip.outward_in_map + strip.along_in_map)


def strips(frame: Frame, top: np.ndarray, tuning: HungCornerTuning = DEFAULT) -> list[Strip]:
    """The strips of the neckline's tape that fall from the hook at `top` (3,) in the map [m].

    They are parted twice, with a wider and with a narrower gap, so the same strip may be in the list twice.
    """
    labels, cloud = gown_labels(frame), points_in_map(frame)
    seen = frame.depth > 0
    armhole = cloud[(labels == Surface.ARMHOLE) & seen]
    fabric = _Pixels.of(frame, np.isin(labels, (Surface.OUTSIDE, Surface.INSIDE)) & seen, cloud)
    outside = labels[fabric.rows, fabric.columns] == Surface.OUTSIDE
    with np.errstate(invalid="ignore"):
        lower = (labels == Surface.COLLAR) & seen & (cloud[..., 2] < top[2] - tuning.parting_drop)
        lower &= np.linalg.norm(cloud - top, axis=2) > tuning.parting_distance
    collar = _Pixels.of(frame, lower, cloud)
    if len(collar.points) < tuning.min_points:
        return []
    found = []
    for gap in tuning.max_steps:
        patch = clusters(collar.points, gap)
        for k in np.flatnonzero(np.bincount(patch) >= tuning.min_points):
            found.append(_strip(collar.only(patch == k), fabric, outside, armhole, top, tuning))
    return found


@dataclass(frozen=True, eq=False)
class _Pixels:
    """Pixels with their points: `rows`, `columns` (n,) and `points` (n, 3) in the map [m]."""

    frame: Frame
    rows: np.ndarray
    columns: np.ndarray
    points: np.ndarray

    @classmethod
    def of(cls, frame: Frame, mask: np.ndarray, cloud: np.ndarray) -> _Pixels:
        """Those of a mask (H, W), with their points from `cloud` (H, W, 3) [m]."""
        rows, columns = np.nonzero(mask)
        return cls(frame, rows, columns, cloud[rows, columns])

    def only(self, chosen: np.ndarray) -> _Pixels:
        """Those of them that `chosen` (n,) names."""
        return _Pixels(self.frame, self.rows[chosen], self.columns[chosen], self.points[chosen])


def _strip(
    collar: _Pixels,
    fabric: _Pixels,
    outside: np.ndarray,
    armhole: np.ndarray,
    top: np.ndarray,
    tuning: HungCornerTuning,
) -> Strip:
    """One strip from its pixels `collar`; `outside` (n,) marks the fabric's printed side, `armhole` (k, 3) its tape."""
    points = collar.points
    far = np.linalg.norm(points - top, axis=1)
    last_end, first_end = points[far > far.max() - tuning.end_length], points[far < far.min() + tuning.end_length]
    along = unit(np.median(last_end, axis=0) - np.median(first_end, axis=0))
    if far.max() - far.min() < 2 * tuning.end_length:  # short: it falls from the hook
        along = unit(points.mean(axis=0) - top)
    run = (points - top) @ along
    end = points[run > run.max() - tuning.end_length]
    middle = end.mean(axis=0)
    across = end - middle
    across -= np.outer(across @ along, along)
    outward = np.linalg.svd(across, full_matrices=False)[2][0]
    near = fabric.points[np.linalg.norm(fabric.points - middle, axis=1) < tuning.fabric_distance] - middle
    near = near[near @ along < 0.0] @ outward
    if len(near) and np.median(np.sign(near)) > 0.0:
        outward = -outward
    spread = across @ outward
    low, high = np.percentile(spread, (3, 97))
    corner = middle + high * outward + (float(np.percentile(run, 99)) - float((middle - top) @ along)) * along
    beside = int((np.linalg.norm(armhole - corner, axis=1) < tuning.armhole_distance).sum())
    last = points[run > run.max() - tuning.last_length]
    width = float(high - low)
    blunt = float(np.ptp(last @ outward)) / max(width, 1e-3)
    cut = _cut(collar.frame, middle, along, outward, tuning.beyond_width * width, tuning)
    return Strip(
        corner_in_map=corner,
        tip_in_map=np.median(last, axis=0),
        along_in_map=along,
        outward_in_map=outward,
        width=width,
        length=float(np.linalg.norm(corner - top)),
        armhole=min(1.0, beside / tuning.full_armhole_points),
        tells=_side(collar, fabric, outside, far, tuning),
        blunt=blunt,
        cut=cut,
        shows=width > tuning.min_width and blunt > tuning.min_bluntness and cut < tuning.max_cut,
    )


def _cut(
    frame: Frame, end: np.ndarray, along: np.ndarray, outward: np.ndarray, half: float, tuning: HungCornerTuning
) -> float:
    """Share of the places just beyond the end (3,) of a strip where something nearer to the camera is seen."""
    places = np.array(
        [
            end + (0.5 * tuning.end_length + step) * along + side * half * outward
            for step in tuning.beyond_steps
            for side in (-1.0, 0.0, 1.0)
        ]
    )
    u, v, z = project(frame, places).T
    height, width = frame.depth.shape
    column, row = np.clip(np.rint(u).astype(int), 0, width - 1), np.clip(np.rint(v).astype(int), 0, height - 1)
    there = frame.depth[row, column]
    return float(np.mean((there > 0) & (there < z - tuning.front_margin)))


def _side(collar: _Pixels, fabric: _Pixels, outside: np.ndarray, far: np.ndarray, tuning: HungCornerTuning) -> float:
    """Which strip it is, by the fabric that is sewn to it; see `Strip.tells`.

    Seen from outside, the fabric lies to the left of the wearer's left strip on its way down (clockwise from it), and
    to the right of the right one; where the inside shows, the two are swapped.
    """
    from scipy.spatial import KDTree

    found = KDTree(collar.points).query(fabric.points, distance_upper_bound=tuning.sewn_distance)
    gap, nearest = np.asarray(found[0]), np.asarray(found[1])
    sewn = np.isfinite(gap)
    both = far < far.min() + tuning.side_length, far > far.max() - tuning.side_length
    ends = [np.median(collar.points[part], axis=0) for part in both]
    down = np.diff(project(collar.frame, np.stack(ends))[:, :2], axis=0)[0]
    if sewn.sum() < tuning.min_sewn_points or np.linalg.norm(down) < tuning.min_strip_pixels:
        return 0.0
    away = np.column_stack(
        (fabric.columns[sewn] - collar.columns[nearest[sewn]], fabric.rows[sewn] - collar.rows[nearest[sewn]])
    )
    clockwise = down[0] * away[:, 1] - down[1] * away[:, 0]  # rows grow downwards
    return float(-np.mean(np.sign(clockwise) * np.where(outside[sewn], 1.0, -1.0)))


def _in_fold(frame: Frame, found: list[Strip], top: np.ndarray, length: float, tuning: HungCornerTuning) -> np.ndarray:
    """The corner (3,) of a strip of which only the upper part is seen: just above its armhole, or by its length [m].

    Raises:
        PerceptionFailure: no strip falls below the hook.
    """
    sideways = frame.pose_camera_in_map[:3, 0]
    below = [strip for strip in found if abs((strip.tip_in_map - top) @ sideways) < tuning.below_hook * strip.length]
    if not below:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "second strip of the hung gown's neckline")
    tip = max(below, key=lambda each: each.length).tip_in_map
    fall_squared = max(length**2 - float(((tip - top)[:2] ** 2).sum()), tuning.min_fall_squared)
    level = min(top[2] - np.sqrt(fall_squared), tip[2])
    aside, around = tuning.fold_distance
    labels, cloud = gown_labels(frame), points_in_map(frame)
    seen = (frame.depth > 0) & (np.abs((cloud - tip) @ sideways) < aside)
    seen &= np.abs(cloud[..., 2] - level) < tuning.length_tolerance
    seen &= np.linalg.norm((cloud - tip)[..., :2], axis=2) < around
    armhole = cloud[seen & (labels == Surface.ARMHOLE)]
    if len(armhole) >= tuning.min_fold_points:
        level = float(np.percentile(armhole[:, 2], 95)) + tuning.armhole_to_corner
    ahead = np.cross((0.0, 0.0, 1.0), sideways)
    lean = -tuning.fold_lean * (top[2] - level) - (tip - top) @ ahead
    return np.array((*(tip + lean * ahead)[:2], level))


def _grasp(frame: Frame, position: np.ndarray, target: GraspTarget, confidence: float) -> GraspPoint:
    """A grasp at a place (3,) in the map [m], level and along the view."""
    approach = unit((position - frame.pose_camera_in_map[:3, 3]) * (1.0, 1.0, 0.0))
    return GraspPoint(
        stamp=frame.stamp,
        confidence=confidence,
        target=target,
        position_in_map=position,
        approach_in_map=approach,
        closing_in_map=np.array((-approach[1], approach[0], 0.0)),
    )

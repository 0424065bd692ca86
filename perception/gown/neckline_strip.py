"""The strips in which the tape of a hung gown's neckline falls from the hook: where each ends, and which one it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..image.cloud import clusters, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map, project
from ..image.surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class StripTuning(Quantities):
    """Numbers of finding strips, and of telling how each lies."""

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
    image_border: int = quantity(
        3, "px", "of the picture, within which an end is cut off", "choice: what lies there may go on outside"
    )
    # what makes a corner certain
    min_width: float = quantity(0.043, "m", "of a strip flat to the camera", "choice: of a tape of 0.055 m")
    min_bluntness: float = quantity(0.85, "1", "of a strip that is seen to its end", "choice: by trial, not recorded")
    max_cut: float = quantity(0.15, "1", "of a strip that is seen to its end", "choice: one of nine places is noise")


DEFAULT = StripTuning()


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
        whole: whether it ends inside of the picture; else it may go on outside.
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
    whole: bool
    shows: bool


def strips(frame: Frame, top: np.ndarray, tuning: StripTuning = DEFAULT) -> list[Strip]:
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
    tuning: StripTuning,
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
    whole = _inside(collar.only(run > run.max() - tuning.last_length), tuning)
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
        whole=whole,
        shows=whole and width > tuning.min_width and blunt > tuning.min_bluntness and cut < tuning.max_cut,
    )


def _inside(end: _Pixels, tuning: StripTuning) -> bool:
    """Whether the end of a strip lies inside of the picture: at its border, it may go on outside."""
    height, width = end.frame.depth.shape
    border = tuning.image_border
    return bool(
        end.rows.min() >= border
        and end.rows.max() < height - border
        and end.columns.min() >= border
        and end.columns.max() < width - border
    )


def _cut(
    frame: Frame, end: np.ndarray, along: np.ndarray, outward: np.ndarray, half: float, tuning: StripTuning
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


def _side(collar: _Pixels, fabric: _Pixels, outside: np.ndarray, far: np.ndarray, tuning: StripTuning) -> float:
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

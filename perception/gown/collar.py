"""The tape along the neckline: its two ends, and its middle on the person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from ..image.cloud import across, clusters, geodesic, main_direction, surface_normal, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surface_area import surface_areas
from ..image.surfaces import GOWN_SURFACES, Surface
from .gown_facts import GOWN


@dataclass(frozen=True, kw_only=True)
class CollarTuning(Quantities):
    """Numbers of the neckline's ends and of its middle."""

    max_points: int = quantity(1200, "1", "of the tape that are worked on", "choice: bounds the computing time")
    min_points: int = quantity(15, "1", "of the tape that are needed", "choice: fewer are noise")
    max_step: float = quantity(
        0.03, "m", "between neighbours on one piece of cloth", "choice: larger steps are steps in depth"
    )
    image_border: int = quantity(
        4, "px", "within which a thing is cut off", "choice: what lies there may go on outside"
    )
    min_piece_points: int = quantity(12, "1", "of a piece that has ends", "choice: smaller pieces are specks")
    end_length: float = quantity(0.03, "m", "of a piece that is its end", "choice: half the tape's width")
    direction_range: tuple[float, float] = quantity(
        (0.05, 0.11), "m", "from the tip, of the part that gives the end's direction", "choice: beyond the end itself"
    )
    min_direction_points: int = quantity(4, "1", "of that part", "choice: fewer give no direction")
    cut_off_score: float = quantity(0.05, "1", "of an end at the picture's border", "choice: it may go on outside")
    armhole_distance: float = quantity(
        0.08, "m", "from a corner, within which tape of the armhole counts", "choice: the armhole begins at the corner"
    )
    full_armhole_points: int = quantity(10, "1", "of that tape, from which it is certain", "choice: clear of noise")
    full_end_points: int = quantity(20, "1", "of an end, from which its size is certain", "choice: clear of noise")
    armhole_weight: float = quantity(0.75, "1", "of the armhole's tape in the score", "choice: it tells a corner best")
    size_weight: float = quantity(0.6, "1", "of the end's size in the score", "choice: of less weight than the armhole")
    facing_weight: float = quantity(0.6, "1", "of how squarely the end is seen", "choice: the same as its size")
    body_distance: float = quantity(
        0.6,
        "m",
        "from the middle between the shoulders to a worn gown's neckline",
        "choice: half an adult's breadth more",
    )
    worn_step: float = quantity(
        0.06,
        "m",
        "between neighbours on the tape of a worn gown",
        "measured: 12 views of worn gowns, seeds 101-105: the middle is found to 0.07 m (root mean square)",
    )
    area_radius: float = quantity(
        0.022,
        "m",
        "of the surface round a point that tells how it is tilted",
        "choice: less than half the tape's width",
    )
    min_cosine: float = quantity(
        0.2,
        "1",
        "between tape and line of sight, below which it is not foreshortened more",
        "choice: noise rules there",
    )
    slice_width: float = quantity(
        0.02,
        "m",
        "of slices across the body, in each of which the tape's length is told",
        "measured: 66 views from the head of the bed of seeds 101 to 111, half of them looked at before: it "
        "is found to 0.029 m aside (root mean square), at worst 0.09 m; along the shortest way on the tape, on 54 of "
        "them, to 0.070 and 0.16 m",
    )
    fold: float = quantity(
        0.06,
        "m",
        "between neighbouring slices, beyond which the tape between them is folded under, and does not show",
        "measured: where it was, by 0.1 to 0.4 m, the middle was seen 0.05 m headward (0) or 0.11 m aside (166)",
    )
    grasp_length: float = quantity(0.06, "m", "of the tape's middle, which is grasped", "choice: a tape's width")
    straight_length: float = quantity(
        0.35, "m", "of the tape from either end, which is looked at for folds", "choice: most of its half"
    )
    end_beyond: float = quantity(
        0.28,
        "m",
        "from the middle between the shoulders, beyond which an end that shows is the tape's own",
        "measured: those views; ends that were not the tape's own lay within 0.25 m, the others beyond 0.28 m",
    )
    per_metre_short: float = quantity(
        4.0,
        "1/m",
        "doubt in an end for each metre that it lies nearer",
        "measured: those views; the middle is found to 0.04 m, 0.07 m by how much the ends look like corners",
    )
    low: float = quantity(
        0.05,
        "m",
        "above the shoulders, below which an end has gone round a fold or a shoulder",
        "measured: the views of `per_metre_off_armhole`",
    )
    per_metre_low: float = quantity(
        16.0,
        "1/m",
        "doubt in an end for each metre that it lies lower",
        "measured: the views of `per_metre_off_armhole`",
    )
    beside_armhole: float = quantity(
        0.06,
        "m",
        "from the armhole's tape, within which an end is the neckline's own",
        "measured: the views of `per_metre_off_armhole`",
    )
    per_metre_off_armhole: float = quantity(
        8.0,
        "1/m",
        "doubt in an end for each metre that it lies farther off",
        "measured: 55 views from the head of the bed of 30 runs on seeds 101 to 104 and 0, by a coarse search: the "
        "middle is found to 0.041 m aside (root mean square), at worst 0.11 m, without both terms to 0.065 and 0.21 m",
    )
    hidden_floor: float = quantity(0.02, "1", "least doubt in an end", "choice: tape may always hide in a fold")
    even_doubt: float = quantity(
        0.3, "1", "in both ends alike", "measured: the views of `slice_width`: where all shows, some is missed anywhere"
    )


DEFAULT = CollarTuning()


@dataclass(frozen=True)
class CornerCandidate:
    """One end of a visible piece of the neckline's tape.

    Attributes:
        position_in_map: (3,) [m].
        outward_in_map: (3,) unit vector along the tape, off its end.
        score: 0 to 1, how much it looks like a corner rather than a fold or something in front.
    """

    position_in_map: np.ndarray
    outward_in_map: np.ndarray
    score: float


def _neckline_tape(frame: Frame, tuning: CollarTuning) -> tuple[np.ndarray, np.ndarray, float]:
    """Pixels (n, 2) as (u, v) and points (n, 3) [m] in the map of the neckline's tape, and which share they are."""
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels == Surface.COLLAR) & (frame.depth > 0))
    if len(rows) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neck binding of the gown")
    points = points_in_map(frame)[rows, columns]
    step = max(1, len(rows) // tuning.max_points + (len(rows) % tuning.max_points > 0))
    return np.column_stack([columns, rows])[::step], points[::step], 1.0 / step


def corner_candidates(frame: Frame, tuning: CollarTuning = DEFAULT) -> list[CornerCandidate]:
    """Ends of every visible piece of the neckline's tape, best first.

    A piece of tape ends at a corner, where it turns out of sight, behind other cloth, or at the picture's border.  At a
    corner the armhole begins: its tape is close.

    Raises:
        PerceptionFailure: no gown, or no tape of its neckline.
    """
    pixels, points, _ = _neckline_tape(frame, tuning)
    armhole = _armhole_points(frame)
    labels = clusters(points, tuning.max_step)
    low, high = tuning.direction_range
    found = []
    for piece in range(labels.max() + 1):
        mine = np.flatnonzero(labels == piece)
        if len(mine) < tuning.min_piece_points:
            break  # pieces are sorted by size
        cloud, uv = points[mine], pixels[mine]
        tips = [int(np.argmax(geodesic(cloud, 0, tuning.max_step)))]
        along = geodesic(cloud, tips[0], tuning.max_step)
        tips.append(int(np.argmax(along)))
        for tip in tips:
            from_tip = along if tip == tips[0] else geodesic(cloud, tip, tuning.max_step)
            end, behind = from_tip < tuning.end_length, (from_tip > low) & (from_tip < high)
            if behind.sum() < tuning.min_direction_points:
                continue
            position = np.median(cloud[end], axis=0)
            outward = unit(position - np.median(cloud[behind], axis=0))
            score = _corner_score(frame, cloud[end], uv[tip], armhole, tuning)
            found.append(CornerCandidate(position, outward, score))
    if not found:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "end of the neck binding")
    return sorted(found, key=lambda c: -c.score)


def _armhole_points(frame: Frame) -> np.ndarray:
    """(n, 3) points of the armholes' tape in the map [m]."""
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels == Surface.ARMHOLE) & (frame.depth > 0))
    return points_in_map(frame)[rows, columns]


def _corner_score(frame: Frame, end: np.ndarray, tip: np.ndarray, armhole: np.ndarray, tuning: CollarTuning) -> float:
    """How much the end (n, 3) of a piece of tape, with its last pixel `tip` (2,), looks like a corner (0 to 1)."""
    height, width = frame.depth.shape
    border = tuning.image_border
    if not (border < tip[0] < width - 1 - border and border < tip[1] < height - 1 - border):
        return tuning.cut_off_score
    position = np.median(end, axis=0)
    close = int((np.linalg.norm(armhole - position, axis=1) < tuning.armhole_distance).sum()) if len(armhole) else 0
    size = min(1.0, len(end) / tuning.full_end_points)
    towards = frame.pose_camera_in_map[:3, 3]
    facing = abs(surface_normal(end, towards) @ unit(towards - position))
    share = min(1.0, close / tuning.full_armhole_points)
    score = 1.0
    for weight, value in (
        (tuning.armhole_weight, share),
        (tuning.size_weight, size),
        (tuning.facing_weight, facing),
    ):
        score *= (1 - weight) + weight * value
    return float(score)


def collar_middle(
    frame: Frame,
    near_in_map: np.ndarray,
    away: tuple[float, float] = (0.0, 0.0),
    tuning: CollarTuning = DEFAULT,
    beside: Sequence[Frame] = (),
) -> GraspPoint:
    """The middle of a worn gown's neckline: about as much of the tape lies on either side of it.

    What is hidden is shared between its ends.  A taut half hides nothing, and a slack one has folds: the less straight
    the tape runs from an end, the nearer to the midline and the lower that end lies, and the farther off the armhole,
    the more is hidden there.  Of several pictures each shows what a fold or a shoulder hides from the others.

    Args:
        frame: a view from above the person.
        near_in_map: (3,) middle between the shoulders [m].
        away: from the middle to where the cloth is to be grasped, along x and y in the map [m].
        tuning: numbers of the search.
        beside: more views of the same cloth, from elsewhere.

    Returns:
        The grasp in the map, with an approach into the cloth; its confidence is the share of the tape that shows.

    Raises:
        PerceptionFailure: too little tape is seen there, in any of them.
    """
    seen = [view for view in (_worn_tape(each, near_in_map, tuning) for each in (frame, *beside)) if view is not None]
    if not seen:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neck binding on the person")
    tape = np.concatenate([points for _, points, _ in seen])
    across_body = main_direction(tape)
    across_body *= np.sign(across_body[0]) or 1.0  # the wearer's right: in the map the head lies at -y, the feet at y
    middles, lengths = slices_across([(points, areas) for _, points, areas in seen], across_body, tuning)
    shown = float(lengths.sum())
    hidden = max(0.0, GOWN.neckline_length - shown)
    doubts = [_doubt(each, points, near_in_map, across_body, tuning) for each, points, _ in seen]
    doubt = (tuning.even_doubt + np.min(doubts, axis=0)) ** 2
    place = (shown + hidden) / 2 + GOWN.neckline_middle - hidden * doubt[0] / doubt.sum()
    along = np.cumsum(lengths) - lengths / 2
    position = np.array([np.interp(place, along, axis) for axis in middles.T])
    return _grasp(frame, tape, position, max(0.0, shown - _folded_under(middles, tuning)), away, tuning)


def _worn_tape(
    frame: Frame, near_in_map: np.ndarray, tuning: CollarTuning
) -> tuple[Frame, np.ndarray, np.ndarray] | None:
    """A picture with points (n, 3) of the tape on the person and its area (n,) at each; None where hardly any shows."""
    try:
        _, points, share = _neckline_tape(frame, tuning)
    except PerceptionFailure:
        return None
    worn = np.linalg.norm((points - near_in_map)[:, :2], axis=1) < tuning.body_distance
    if np.count_nonzero(worn) < tuning.min_points:
        return None
    return frame, points[worn], surface_areas(frame, points, tuning.area_radius, tuning.min_cosine)[worn] / share


def _folded_under(middles: np.ndarray, tuning: CollarTuning) -> float:
    """Length of the tape between neighbouring slices (m, 3), in their order, that are too far apart to show it [m]."""
    steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    return float((steps[steps > tuning.fold] - tuning.fold).sum())


def slices_across(
    views: Sequence[tuple[np.ndarray, np.ndarray]], across_body: np.ndarray, tuning: CollarTuning
) -> tuple[np.ndarray, np.ndarray]:
    """Middles (m, 3) and lengths of tape (m,) of slices across the body, in their order [m].

    Each has as much tape as its area tells, which folds in it do not shorten, or as is needed to reach its neighbours,
    where the tape is seen from its side or not at all.  Of several views the one counts that shows most of a slice.

    Args:
        views: of each the points (n, 3) of the tape [m], and the area (n,) of the tape at each of them [m^2].
        across_body: (3,) unit vector.
        tuning: numbers of the search.
    """
    first = min(float((points @ across_body).min()) for points, _ in views)
    slices = [np.floor((points @ across_body - first) / tuning.slice_width).astype(int) for points, _ in views]
    count = max(int(each.max()) for each in slices) + 1
    area = np.array([np.bincount(each, areas, count) for each, (_, areas) in zip(slices, views, strict=True)])
    area[[np.bincount(each, minlength=count) == 0 for each in slices]] = -1.0  # nothing of it shows
    shows = np.flatnonzero(area.max(axis=0) >= 0.0)
    best = area.argmax(axis=0)[shows]
    middles = np.array([np.median(views[k][0][slices[k] == n], axis=0) for n, k in zip(shows, best, strict=True)])
    steps = np.pad(np.linalg.norm(np.diff(middles, axis=0), axis=1), 1, constant_values=tuning.slice_width)
    return middles, np.maximum(area[best, shows] / GOWN.strap_width, (steps[:-1] + steps[1:]) / 2)


def _doubt(
    frame: Frame, points: np.ndarray, middle: np.ndarray, across_body: np.ndarray, tuning: CollarTuning
) -> np.ndarray:
    """(2,) how much is hidden beyond either end of the longest piece of tape (n, 3), in order of `across_body` (3,)."""
    points = points[clusters(points, tuning.worn_step) == 0]
    first = int(np.argmax(geodesic(points, 0, tuning.worn_step)))
    along = geodesic(points, first, tuning.worn_step)
    last = int(np.argmax(along))
    back = geodesic(points, last, tuning.worn_step)
    armhole = _armhole_points(frame)
    ends = [(first, along), (last, back)]
    ends.sort(key=lambda end: points[end[0]] @ across_body)
    return np.array([hidden_at(points, end, way, middle, armhole, tuning) for end, way in ends])


def _grasp(
    frame: Frame,
    points: np.ndarray,
    position: np.ndarray,
    shown: float,
    away: tuple[float, float],
    tuning: CollarTuning,
) -> GraspPoint:
    """At a position (3,) on the tape, of which points (n, 3) and a length `shown` [m] show, or `away` from it [m]."""
    distance = np.linalg.norm(points - position, axis=1)
    strip = points[distance < max(tuning.grasp_length, float(np.sort(distance)[tuning.min_points - 1]))]
    along = main_direction(strip)
    if any(away):
        cloth = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
        from_grasp = np.linalg.norm((cloth - position - (*away, 0.0))[:, :2], axis=1)
        if np.count_nonzero(from_grasp < tuning.grasp_length / 3) < tuning.min_points:
            raise PerceptionFailure(Problem.NOTHING_SEEN, "cloth beside the collar")
        position = np.median(cloth[from_grasp < tuning.grasp_length / 3], axis=0)
        strip = cloth[from_grasp < tuning.grasp_length]
    normal = surface_normal(strip, frame.pose_camera_in_map[:3, 3])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=min(1.0, shown / GOWN.neckline_length),
        target="collar_middle",
        position_in_map=position,
        approach_in_map=-normal,
        closing_in_map=across(along, -normal),
    )


def hidden_at(
    points: np.ndarray, end: int, way: np.ndarray, middle: np.ndarray, armhole: np.ndarray, tuning: CollarTuning
) -> float:
    """Doubt (above 0) in an end of the tape: how much it bends, how far inside of a shoulder seam it ends, and how low.

    Args:
        points: (n, 3) of the tape [m].
        end: index of its end.
        way: (n,) of each point from there, along the tape [m].
        middle: (3,) between the shoulders [m].
        armhole: (m, 3) of the armholes' tape, beside which the neckline ends [m].
        tuning: numbers of the search.
    """
    far = int(np.argmin(np.abs(way - tuning.straight_length)))
    straight = float(np.linalg.norm(points[far] - points[end]) / max(way[far], tuning.grasp_length))
    off = points[end] - middle
    short = tuning.end_beyond - float(np.linalg.norm(off[:2]))
    low = tuning.low - float(off[2])
    beside = float(np.linalg.norm(armhole - points[end], axis=1).min(initial=tuning.end_beyond)) - tuning.beside_armhole
    return (
        tuning.hidden_floor
        + max(1.0 - straight, 0.0)
        + tuning.per_metre_short * max(short, 0.0)
        + tuning.per_metre_low * max(low, 0.0)
        + tuning.per_metre_off_armhole * max(beside, 0.0)
    )

"""The hung gown's hook and the two corners of its neckline, where the navy tape ends at the shoulders.

The tape falls from the hook in two strips.  A strip that is seen flat to the camera and down to its end shows its
corner to within a centimetre.  From one of three places about the rail at least one strip is seen like that.  Once that
one is drawn aside, the other strip hangs alone; if it hangs in a narrow fold, its corner is where the fold opens below.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import CORNER_OF, GraspPoint, GraspTarget
from ..image.cloud import clusters, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES, Surface
from .gown_facts import GOWN
from .neckline_strip import Strip, StripTuning, strips


@dataclass(frozen=True, kw_only=True)
class HungCornerTuning(Quantities):
    """Numbers of the search for the hook and the corners of a hung gown."""

    strip: StripTuning = field(default_factory=StripTuning)
    # how a strip lies
    length_range: tuple[float, float] = quantity(
        (0.21, 0.62), "m", "from the hook to a corner, through the air", "choice: by trial, not recorded"
    )
    length_tolerance: float = quantity(
        0.085, "m", "of the length that the other strip leaves for this one", "choice: by trial, not recorded"
    )
    min_side_share: float = quantity(0.6, "1", "of sewn fabric that must agree on the side", "choice: four of five")
    # a corner that shows in part
    part_width: float = quantity(
        0.025,
        "m",
        "of a strip's end that is seen at an angle, at least",
        "measured: on hung gowns of seeds 140 to 174, 22 of 33 such ends with the three bounds below were the corner "
        "to within 0.02 m, 9 lay 0.02 to 0.07 m beside it, two told the wrong side",
    )
    part_bluntness: float = quantity(0.7, "1", "of such an end", "measured: as `part_width`")
    part_side_share: float = quantity(
        0.5, "1", "of sewn fabric that must agree on its side", "measured: of 0.36 and 0.37 it told it wrong (141, 168)"
    )
    part_armhole: float = quantity(1.0, "1", "of the armhole's tape beside it that shows", "measured: as before")
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
    edge_on_aside: float = quantity(
        0.10, "m", "sideways of the hook, of the armhole of a strip that is seen edge-on", "choice: it hangs below it"
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
    part_factor: float = quantity(0.2, "1", "of confidence in a corner that shows in part", "choice: below all others")


DEFAULT = HungCornerTuning()


def hook(frame: Frame, tuning: HungCornerTuning = DEFAULT) -> GraspPoint:
    """Where the gown hangs: the top of its neckline, as a place to grasp from the camera's side.

    Raises:
        PerceptionFailure: no neckline is seen.
    """
    seen = (gown_labels(frame) == Surface.COLLAR) & (frame.depth > 0)
    if seen.sum() < tuning.strip.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "neckline of the hung gown")
    collar = points_in_map(frame)[seen]
    lowest = np.percentile(collar[:, 2], tuning.hook_percentile) - tuning.hook_depth
    top = np.median(collar[collar[:, 2] > lowest], axis=0)
    return _grasp(frame, top, "near_hang", tuning.shown_confidence)


def shown_corner(
    frame: Frame, hook_in_map: np.ndarray, side: Side | None = None, tuning: HungCornerTuning = DEFAULT
) -> GraspPoint:
    """The corner of a hung gown's neckline that shows best; the target tells which one it is.

    A strip counts that is seen down to its end, flat to the camera, and whose fabric tells the side.  Of two the one
    that hangs clear of other cloth is chosen, or else the higher one: nothing hangs in front of it.  Where there is
    none, an end counts that is seen at an angle, the armhole's tape beside it.

    Args:
        frame: of a camera that sees the gown's outside.
        hook_in_map: (3,) where the gown hangs [m].
        side: the wearer's, if only that one is wanted.
        tuning: numbers of the search.

    Returns:
        The grasp, just inside both edges of the tape, with a horizontal approach along the view.  Its confidence is
        below 0.5 where other cloth hangs so near that the fingers might take it too, and below 0.21 where it shows in
        part.

    Raises:
        PerceptionFailure: neither shows.
    """
    wanted = {None: 0.0, "left": -1.0, "right": 1.0}[side]
    shortest, longest = tuning.length_range
    hung = [
        strip
        for strip in strips(frame, hook_in_map, tuning.strip)
        if shortest < strip.length < longest and strip.tells * wanted >= 0.0
    ]
    told = [strip for strip in hung if strip.shows and abs(strip.tells) > tuning.min_side_share]
    if not told:
        return _partly_shown(frame, hung, tuning)
    crowded = {id(strip): _crowded(frame, strip.corner_in_map, tuning) for strip in told}
    best = min(told, key=lambda strip: (crowded[id(strip)], strip.length))
    target = CORNER_OF["right" if best.tells > 0.0 else "left"]
    confidence = abs(best.tells) * (tuning.crowded_factor if crowded[id(best)] else 1.0)
    return _grasp(frame, _inside(best, tuning), target, confidence)


def _partly_shown(frame: Frame, hung: list[Strip], tuning: HungCornerTuning) -> GraspPoint:
    """The corner at that of the strips' ends seen at an angle whose fabric tells the side best.

    Raises:
        PerceptionFailure: there is none.
    """
    ends = [
        strip
        for strip in hung
        if strip.whole
        and strip.width > tuning.part_width
        and strip.blunt > tuning.part_bluntness
        and strip.cut < tuning.strip.max_cut
        and abs(strip.tells) > tuning.part_side_share
        and strip.armhole >= tuning.part_armhole
    ]
    if not ends:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "a corner of the hung gown's neckline")
    best = max(ends, key=lambda strip: abs(strip.tells))
    target = CORNER_OF["right" if best.tells > 0.0 else "left"]
    return _grasp(frame, _inside(best, tuning), target, tuning.part_factor * abs(best.tells))


def _crowded(frame: Frame, corner: np.ndarray, tuning: HungCornerTuning) -> bool:
    """Whether cloth that is not the corner's own sheet is seen beside a corner (3,)."""
    cloud = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
    away = np.linalg.norm(cloud - corner, axis=1)
    near, away = cloud[away < tuning.sheet_distance], away[away < tuning.sheet_distance]
    if len(near) == 0:
        return False
    sheet = clusters(near, tuning.strip.max_steps[0])
    other = (sheet != sheet[np.argmin(away)]) & (away < tuning.clear_distance)
    return int(other.sum()) >= tuning.strip.min_points // 2


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
    found = strips(frame, top, tuning.strip)
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
    confidence = least + more * min(1.0, best.width / tuning.strip.min_width) * best.armhole
    if best.shows:
        confidence = tuning.shown_confidence
    if other_length is None and _crowded(frame, best.corner_in_map, tuning):
        confidence *= tuning.crowded_factor
    return _grasp(frame, _inside(best, tuning), CORNER_OF[side], confidence)


def _ends_at_corner(strip: Strip, length: float, tuning: HungCornerTuning) -> bool:
    """Whether a strip that does not show well still ends at its corner: by its armhole, or by its `length` [m]."""
    if not strip.whole or strip.length >= length + tuning.length_tolerance:
        return False
    if strip.armhole > tuning.min_armhole_share:
        return True
    wide = strip.width > tuning.min_fold_width_share * tuning.fold_width
    return wide and strip.blunt > tuning.fold_bluntness and abs(strip.length - length) < tuning.length_tolerance


def _inside(strip: Strip, tuning: HungCornerTuning) -> np.ndarray:
    """Where to take a strip (3,): what lies behind a fold's edge is not to be taken with it."""
    margin = tuning.inset if strip.width > tuning.fold_width else -tuning.inset
    return strip.corner_in_map - margin * (strip.outward_in_map + strip.along_in_map)


def _in_fold(frame: Frame, found: list[Strip], top: np.ndarray, length: float, tuning: HungCornerTuning) -> np.ndarray:
    """The corner (3,) of a strip of which only the upper part is seen: just above its armhole, or by its length [m].

    Raises:
        PerceptionFailure: no strip falls below the hook.
    """
    sideways = frame.pose_camera_in_map[:3, 0]
    below = [strip for strip in found if abs((strip.tip_in_map - top) @ sideways) < tuning.below_hook * strip.length]
    if not below:
        return _above_armhole(frame, top, length, tuning)
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


def _above_armhole(frame: Frame, top: np.ndarray, length: float, tuning: HungCornerTuning) -> np.ndarray:
    """The corner (3,) of a strip that is seen edge-on, if at all: just above an armhole as far below the hook as it.

    Raises:
        PerceptionFailure: no armhole is seen there.
    """
    away, cloud = points_in_map(frame) - top, points_in_map(frame)
    seen = (frame.depth > 0) & (np.abs(away @ frame.pose_camera_in_map[:3, 0]) < tuning.edge_on_aside)
    seen &= np.abs(np.linalg.norm(away, axis=2) - length) < tuning.length_tolerance
    armhole = cloud[seen & (gown_labels(frame) == Surface.ARMHOLE)]
    if len(armhole) < tuning.min_fold_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "second strip of the hung gown's neckline")
    highest = armhole[armhole[:, 2] >= np.percentile(armhole[:, 2], 90)]
    return np.median(highest, axis=0) + (0.0, 0.0, tuning.armhole_to_corner)


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

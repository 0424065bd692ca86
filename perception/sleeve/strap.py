"""The strap of an armhole from close by: the strip of cloth between the armhole and the gown's upper edge.

The strap becomes the shoulder seam, so the gown is held there when the armhole is pulled up the arm.  It is as wide as
the navy tape of the neckline and goes on where that tape ends, on the bed or hanging over the bed's edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..gown.gown_facts import GOWN
from ..image.cloud import clusters, surface_normal, thinned, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES, Surface
from .lying_sleeve import sleeve_opening
from .strap_edge import DEFAULT as EDGE_DEFAULT
from .strap_edge import StrapEdgeTuning, strap_between


@dataclass(frozen=True, kw_only=True)
class StrapTuning(Quantities):
    """Numbers of the search for a strap, and of the choice between the ways to see it."""

    edge: StrapEdgeTuning = EDGE_DEFAULT
    # the choice
    same_distance: float = quantity(
        0.04, "m", "between the places of two ways to see the strap that agree", "measured: 33 recorded views"
    )
    same_distance_afar: float = quantity(
        0.055, "m", "the same, for the coarser view of the whole armhole", "measured: 33 recorded views"
    )
    whole_points: int = quantity(
        400,
        "1",
        "of a strap between its borders that shows whole",
        "measured: right to 4 cm in all 8 recorded views above",
    )
    spot_radius: float = quantity(
        0.02, "m", "around a grasp that must be plain cloth", "choice: what the fingers cover"
    )
    min_plain_share: float = quantity(0.7, "1", "of that spot that is no tape of a sleeve", "choice: some of it may be")
    full_between_points: int = quantity(
        200, "1", "between the borders that make it certain", "choice: half of a whole one"
    )
    max_between_confidence: float = quantity(
        0.6, "1", "in a strap between its borders only", "choice: the other way misses"
    )
    extent: tuple[float, float] = quantity(
        (5.0, 95.0), "%", "of the points, which are its extent", "choice: leaves noise out"
    )
    # the end of the neckline
    min_neckline_points: int = quantity(30, "1", "of the neckline's tape", "choice: fewer give no direction")
    full_neckline_points: int = quantity(150, "1", "of it that make it certain", "choice: an end seen whole")
    neckline_step: float = quantity(
        0.02, "m", "between neighbours on one piece of the neckline", "choice: half its width"
    )
    end_length: float = quantity(
        0.09, "m", "of the neckline that gives its direction", "choice: it bends over the bed's edge"
    )
    body_distance: float = quantity(
        0.12, "m", "around that end, of gown that tells its lower side", "choice: twice its width"
    )
    end_percentile: float = quantity(98.0, "%", "along the neckline, which is its end", "choice: leaves noise out")
    edge_percentiles: tuple[float, float] = quantity(
        (97.0, 95.0),
        "%",
        "across the neckline and across the strap, which are the upper edge",
        "choice: leaves noise out",
    )
    # the walk along the strap
    step: float = quantity(0.0137, "m", "of the walk along the strap", "choice: six lead to its middle")
    min_steps: int = quantity(4, "1", "of six at which the strap is seen", "choice: most of them")
    min_step_points: int = quantity(6, "1", "of the gown around a step", "choice: fewer are noise")
    slab_half_length: float = quantity(
        0.6, "1", "of a step, of the slab of cloth it looks at", "choice: slabs overlap a bit"
    )
    slab_half_height: float = quantity(0.025, "m", "of that slab, off the cloth", "choice: the strap bends that much")
    slab_half_width: float = quantity(0.05, "m", "of that slab, across the strap", "choice: all of the strap and more")
    strap_margin: float = quantity(0.005, "m", "beyond either side of the strap", "choice: depth noise")
    max_shift: float = quantity(0.01, "m", "sideways at one step", "choice: a strap is nearly straight")
    turn_weight: float = quantity(0.5, "1", "of what one step says about directions", "choice: damps noise")
    normal_distance: float = quantity(
        0.03, "m", "from a step, of cloth that tells its normal", "choice: half a strap's width"
    )
    min_normal_points: int = quantity(12, "1", "of that cloth", "choice: fewer are noise")


DEFAULT = StrapTuning()


def sleeve_strap(frame: Frame, side: Side, near_in_map: np.ndarray, tuning: StrapTuning = DEFAULT) -> SleeveOpening:
    """Find the strap and how it lies.

    Two ways to see it are compared.  The first looks between the armhole and the gown's edge, and is the better one
    where the strap shows whole.  The second goes on from the end of the neckline, and needs less of the strap.  In
    recorded views the first was right to 4 cm in all 8 where it had 400 points and more, and wrong by 7 to 23 cm in the
    12 others.  There the second one counts, if the view of the whole armhole agrees with it and no sleeve has fallen
    over its place.

    Args:
        frame: a view from close by, such as a hand camera's.
        side: the wearer's sleeve that is meant.
        near_in_map: (3,) roughly where its armhole is [m].
        tuning: numbers of the search.

    Returns:
        Position: middle of the strap.  Approach: into the side of the cloth that is seen.  Closing: unit vector across
        the strap; approach x closing points along it, from the neckline outwards on the wearer's left, and opposite on
        the right.  Where the strap is not twisted, closing points from the armhole to the gown's upper edge.

    Raises:
        PerceptionFailure: no armhole near the place, or the strap is hidden.
    """
    try:
        between = strap_between(frame, near_in_map, tuning.edge)
    except PerceptionFailure:
        return _past_neckline(frame, side, near_in_map, tuning)
    try:
        past = _past_neckline(frame, side, near_in_map, tuning)
        if np.linalg.norm(past.position_in_map - between.middle) < tuning.same_distance:
            return past
        if between.points < tuning.whole_points:
            whole = sleeve_opening(frame, side, near_in_map)
            agrees = np.linalg.norm(past.position_in_map - whole.position_in_map) < tuning.same_distance_afar
            if agrees and _plain(frame, past.position_in_map, tuning):
                return past
    except PerceptionFailure:
        pass
    # a strap folded over, its inside up, is held the other way round: see above what closing means
    across = -between.across if between.inside else between.across
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=min(tuning.max_between_confidence, between.points / tuning.full_between_points),
        target=SLEEVE_OF[side],
        position_in_map=between.middle,
        approach_in_map=-between.normal,
        closing_in_map=across,
        armhole_points_in_map=between.rim,
        centre_in_map=np.percentile(between.rim, tuning.extent, axis=0).mean(axis=0),
    )


def _plain(frame: Frame, place: np.ndarray, tuning: StrapTuning) -> bool:
    """Whether the strap itself shows at a place (3,), and not a sleeve that has fallen over it."""
    around = np.nan_to_num(np.linalg.norm(points_in_map(frame) - place, axis=2), nan=np.inf) < tuning.spot_radius
    plain = np.isin(gown_labels(frame)[around], (Surface.OUTSIDE, Surface.INSIDE, Surface.COLLAR))
    return bool(around.any() and plain.mean() > tuning.min_plain_share)


def _past_neckline(frame: Frame, side: Side, near_in_map: np.ndarray, tuning: StrapTuning) -> SleeveOpening:
    """The strap along the line of the neckline, past the neckline's end."""
    labels, cloud = gown_labels(frame), points_in_map(frame)
    near = np.nan_to_num(np.linalg.norm(cloud - near_in_map, axis=2), nan=np.inf) < tuning.edge.search_radius
    rim = thinned(cloud[(labels == Surface.ARMHOLE) & near])
    navy = thinned(cloud[(labels == Surface.COLLAR) & near])
    if len(rim) < tuning.edge.min_armhole_points or len(navy) < tuning.min_neckline_points:
        what = "rim" if len(rim) < tuning.edge.min_armhole_points else "end of the neck binding beside"
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"{what} of the {side} armhole")
    rim = rim[clusters(rim, tuning.edge.armhole_step) == 0]
    navy = navy[clusters(navy, tuning.neckline_step) == 0]
    gown = thinned(cloud[np.isin(labels, GOWN_SURFACES) & near], tuning.edge.max_points)
    eye = frame.pose_camera_in_map[:3, 3]
    start, along, headward = _end_of_neckline(navy, rim, gown, eye, tuning)
    middle, along, headward, found = _walk(gown, start, along, headward, eye, tuning)
    if found < tuning.min_steps:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"strap of the {side} armhole")
    normal = np.cross(headward, along)
    normal *= np.sign(normal @ (eye - middle))
    closing = np.cross(along, normal) * (1.0 if side == "right" else -1.0)
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=found / _steps(tuning) * min(1.0, len(navy) / tuning.full_neckline_points),
        target=SLEEVE_OF[side],
        position_in_map=middle,
        approach_in_map=-normal,
        closing_in_map=closing,
        armhole_points_in_map=rim,
        centre_in_map=np.percentile(rim, tuning.extent, axis=0).mean(axis=0),
    )


def _steps(tuning: StrapTuning) -> int:
    """Steps from the neckline's end to the middle of the strap."""
    return round(GOWN.strap_half_length / tuning.step)


def _end_of_neckline(
    navy: np.ndarray, rim: np.ndarray, gown: np.ndarray, eye: np.ndarray, tuning: StrapTuning
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middle of the neckline's end (3,), direction out of it (3,), and the one towards the gown's upper edge (3,)."""
    last = navy
    along = np.linalg.svd(navy - navy.mean(axis=0), full_matrices=False)[2][0]
    along *= np.sign(along @ (rim.mean(axis=0) - navy.mean(axis=0)))
    for _ in range(2):  # the tape may bend over the bed's edge: its last centimetres give the direction
        marks = navy @ along
        last = navy[marks > marks.max() - tuning.end_length]
        axes = np.linalg.svd(last - last.mean(axis=0), full_matrices=False)[2]
        turned = max(axes[:2], key=lambda axis: abs(axis @ along))
        along = unit(along + turned * np.sign(turned @ along))
    marks = last @ along
    normal = surface_normal(last, eye)
    headward = unit(np.cross(normal, along))
    body = gown[np.linalg.norm(gown - last.mean(axis=0), axis=1) < tuning.body_distance].mean(axis=0)
    headward *= -np.sign(headward @ (body - last.mean(axis=0)))
    across = last @ headward
    end = last.mean(axis=0)
    end = end + along * (np.percentile(marks, tuning.end_percentile) - end @ along)
    edge = np.percentile(across, tuning.edge_percentiles[0])
    return end + headward * (edge - GOWN.strap_width / 2 - end @ headward), along, headward


def _walk(
    gown: np.ndarray, start: np.ndarray, along: np.ndarray, headward: np.ndarray, eye: np.ndarray, tuning: StrapTuning
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """From the neckline's end to the middle of the strap: point, directions, and the number of steps that saw it."""
    here, found, half_width = start, 0, GOWN.strap_width / 2
    for _ in range(_steps(tuning)):
        normal = np.cross(headward, along)
        ahead = here + tuning.step * along
        offset = gown - ahead
        slab = np.abs(offset @ along) < tuning.slab_half_length * tuning.step
        near = slab & (np.abs(offset @ normal) < tuning.slab_half_height)
        near &= np.abs(offset @ headward) < tuning.slab_half_width
        if near.sum() < tuning.min_step_points:
            here = ahead
            continue
        found += 1
        edge = float(np.percentile(offset[near] @ headward, tuning.edge_percentiles[1]))
        strip = near & (np.abs(offset @ headward - edge + half_width) < half_width + tuning.strap_margin)
        deep = float(np.median(offset[strip] @ normal)) if strip.any() else 0.0
        shift = np.clip(edge - half_width, -tuning.max_shift, tuning.max_shift)
        reached = ahead + headward * shift + normal * deep
        along = unit(along + tuning.turn_weight * unit(reached - here))
        here = reached
        headward = unit(headward - (headward @ along) * along)
        around = gown[(np.linalg.norm(gown - here, axis=1) < tuning.normal_distance)]
        if len(around) >= tuning.min_normal_points:
            up = surface_normal(around, eye)
            up = up if up @ normal > 0 else -up
            up = unit(normal + tuning.turn_weight * (up - (up @ along) * along))
            headward = unit(np.cross(along, up)) * np.sign(np.cross(along, up) @ headward)
    return here, along, headward, found

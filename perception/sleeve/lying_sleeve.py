"""The armhole of a lying gown that an arm has to go through, and where to take hold of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..gown.gown_facts import GOWN
from ..image.cloud import across, clusters, geodesic, main_direction, surface_normal, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import Surface


@dataclass(frozen=True, kw_only=True)
class LyingSleeveTuning(Quantities):
    """Numbers of the search for an armhole of a lying gown and for the strap above it."""

    # the armhole
    min_points: int = quantity(15, "1", "of armhole tape", "choice: fewer are noise")
    max_step: float = quantity(0.025, "m", "between neighbours on one piece of cloth", "choice: half the tape's width")
    min_piece_points: int = quantity(8, "1", "of a piece of the tape", "choice: fewer are noise")
    max_distance: float = quantity(
        0.55, "m", "of an armhole from where it should be", "choice: the other armhole is 0.8 m away"
    )
    armhole_length: float = quantity(
        0.35,
        "m",
        "of an armhole, from one end of what is seen to the other",
        "choice: pieces within it are one armhole",
    )
    piece_margin: float = quantity(
        0.05,
        "m",
        "beyond half of that, of a piece from the nearest piece",
        "choice: the nearest piece is not the middle",
    )
    normal_distance: float = quantity(
        0.06, "m", "from the grasp, of tape that tells the normal", "choice: a tape's width"
    )
    extent: tuple[float, float] = quantity(
        (5.0, 95.0), "%", "of the points, which are its extent", "choice: leaves noise out"
    )
    # the end of the neckline
    max_neckline_points: int = quantity(1000, "1", "that are worked on", "choice: bounds the computing time")
    max_neckline_distance: float = quantity(
        0.12, "m", "from the armhole to the neckline's end", "choice: farther, that end is hidden"
    )
    end_distance: tuple[float, float] = quantity(
        (0.03, 0.02),
        "m",
        "from the armhole, of the neckline's end: at least, and beyond its nearest",
        "choice: half a tape",
    )
    direction_distance: float = quantity(0.20, "m", "from that end, of tape that tells its direction", "choice: steady")
    tip_percentile: float = quantity(
        92.0, "%", "of the way along it, from which it is the tip", "choice: leaves noise out"
    )
    confidence_distance: float = quantity(
        0.10,
        "m",
        "from the armhole to the neckline, at which confidence is gone",
        "choice: the neckline's end is hidden",
    )
    min_confidence: float = quantity(0.2, "1", "where the neckline's end is hidden", "choice: a guess")
    line_factor: float = quantity(
        0.6, "1", "of confidence where the strap is hidden", "choice: it is taken as straight"
    )
    # the strap
    inset: float = quantity(0.025, "m", "of the grasp from the strap's upper edge", "choice: about half its width")
    strip_half_width: float = quantity(0.03, "m", "of the strip that is followed", "choice: half the strap's width")
    strip_length: float = quantity(0.16, "m", "of the strip that is followed", "choice: an armhole's width")
    strip_start: float = quantity(
        -0.02, "m", "of that strip along the strap, from the neckline's end", "choice: a bit before"
    )
    max_rise: float = quantity(
        0.03, "m", "of the strap above the neckline's end", "choice: the strap may fall off; what rises is the sleeve"
    )
    min_strip_points: int = quantity(10, "1", "of that strip", "choice: fewer are noise")
    middle_half_length: float = quantity(0.015, "m", "of the strap's middle, along it", "choice: a few pixels")
    min_middle_points: int = quantity(4, "1", "of that middle", "choice: fewer are noise")
    upper_percentile: float = quantity(
        60.0, "%", "of the middle, from the upper edge, that is used", "choice: no fold below"
    )


DEFAULT = LyingSleeveTuning()


def sleeve_opening(
    frame: Frame, side: Side, near_in_map: np.ndarray, tuning: LyingSleeveTuning = DEFAULT
) -> SleeveOpening:
    """Find the armhole nearest to a point and the middle of its rim on the shoulder's side.

    The armhole's upper edge, along the strap that will be the shoulder seam, has to travel up the arm, so its middle is
    taken.  The end of the neckline marks that edge; where it is hidden, the middle of what is seen of the armhole is
    taken, with little confidence.

    Args:
        frame: a view of the gown lying on the person.
        side: the wearer's sleeve that is meant, for the name of the target.
        near_in_map: (3,) roughly where it should be, such as below the tracked fingertips [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: no tape of an armhole, or none near the point.
    """
    labels = gown_labels(frame)
    cloud = points_in_map(frame)
    rows, columns = np.nonzero((labels == Surface.ARMHOLE) & (frame.depth > 0))
    if len(rows) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "binding of an armhole")
    points = cloud[rows, columns]
    piece = clusters(points, tuning.max_step)
    pieces = [np.flatnonzero(piece == k) for k in range(piece.max() + 1)]
    pieces = [p for p in pieces if len(p) >= tuning.min_piece_points]
    distances = [np.linalg.norm(points[p].mean(axis=0) - near_in_map) for p in pieces]
    if not pieces or min(distances) > tuning.max_distance:
        raise PerceptionFailure(Problem.OUT_OF_REACH, f"binding of the {side} armhole")
    seed = points[pieces[int(np.argmin(distances))]].mean(axis=0)
    reach = tuning.armhole_length / 2 + tuning.piece_margin
    near = [p for p in pieces if np.linalg.norm(points[p].mean(axis=0) - seed) < reach]
    armhole = points[np.concatenate(near)]
    position, edge, confidence = _strap_edge(labels, cloud, armhole, tuning)
    around = armhole[np.linalg.norm(armhole - position, axis=1) < tuning.normal_distance]
    normal = surface_normal(
        around if len(around) >= tuning.min_piece_points else armhole, frame.pose_camera_in_map[:3, 3]
    )
    low, high = np.percentile(armhole, tuning.extent, axis=0)
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=confidence,
        target=SLEEVE_OF[side],
        position_in_map=position,
        approach_in_map=-normal,
        closing_in_map=across(edge, -normal),
        armhole_points_in_map=armhole,
        centre_in_map=(low + high) / 2,
    )


def _strap_edge(
    labels: np.ndarray, cloud: np.ndarray, armhole: np.ndarray, tuning: LyingSleeveTuning
) -> tuple[np.ndarray, np.ndarray, float]:
    """Middle (3,) of the upper edge of an `armhole` (n, 3), direction (3,) of that edge, and the confidence in it.

    The neckline ends at the armhole's inner upper corner, and the strap continues its line.  The sleeve mostly lies
    folded over that edge, so the edge's middle is not the middle of what is seen: it is half an armhole's width from
    the corner along the strap, which may bend down over the edge of the bed.
    """
    from scipy.spatial import KDTree

    seen = np.isfinite(cloud[..., 2])
    navy = cloud[(labels == Surface.COLLAR) & seen]
    navy = navy[:: len(navy) // tuning.max_neckline_points + 1]
    near = KDTree(armhole).query(navy)[0] if len(navy) >= tuning.min_piece_points else np.array([np.inf])
    if near.min() > tuning.max_neckline_distance:  # hidden: what is seen of the armhole is all there is
        return np.median(armhole, axis=0), main_direction(armhole), tuning.min_confidence
    least, beyond = tuning.end_distance
    end = np.median(navy[near <= max(least, float(near.min()) + beyond)], axis=0)
    tape = navy[np.linalg.norm(navy - end, axis=1) < tuning.direction_distance]
    outward = main_direction(tape)
    if outward @ (end - np.median(navy, axis=0)) < 0:
        outward = -outward
    along = (tape - end) @ outward
    tip = np.median(tape[along >= np.percentile(along, tuning.tip_percentile)], axis=0)
    confidence = float(np.clip(1.0 - near.min() / tuning.confidence_distance, tuning.min_confidence, 1.0))
    lower = np.median(armhole, axis=0) - tip
    lower[2] = 0.0
    lower = unit(lower - (lower @ outward) * outward)
    gown = cloud[(labels != Surface.OTHER) & (labels != Surface.CUFF) & seen]
    strap = _follow(gown, tip, outward, lower, tuning)
    if strap is not None:
        return strap + tuning.inset * lower, unit(strap - tip), confidence
    return tip + GOWN.armhole_half_width * outward + tuning.inset * lower, outward, tuning.line_factor * confidence


def _follow(
    gown: np.ndarray, tip: np.ndarray, outward: np.ndarray, lower: np.ndarray, tuning: LyingSleeveTuning
) -> np.ndarray | None:
    """The point (3,) half an armhole's width from `tip` along the strap's surface, None where it is hidden."""
    offset = gown - tip
    strip = (np.abs(offset @ lower) < tuning.strip_half_width) & (np.linalg.norm(offset, axis=1) < tuning.strip_length)
    strip &= (offset @ outward > tuning.strip_start) & (offset[:, 2] < tuning.max_rise)
    strap = gown[strip]
    if len(strap) < tuning.min_strip_points:
        return None
    along = geodesic(strap, int(np.argmin(np.linalg.norm(strap - tip, axis=1))), tuning.max_step)
    nearest, farthest = (
        GOWN.armhole_half_width + way for way in (-tuning.middle_half_length, tuning.middle_half_length)
    )
    there = (along > nearest) & (along < farthest)
    if there.sum() < tuning.min_middle_points:
        return None
    headmost = (strap @ lower) <= np.percentile(strap[there] @ lower, tuning.upper_percentile)
    return np.median(strap[there & headmost], axis=0)

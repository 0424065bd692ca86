"""Stage C: the armhole that the arm has to go through, and where to take hold of it."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, SleeveOpening
from ..image.cloud import across, clusters, geodesic, main_direction, points_in_map, surface_normal, unit
from ..image.garment import gown_labels
from ..image.surfaces import Surface

_HALF_WIDTH = 0.08  # of an adult's armhole laid flat [m]
_HALF_BINDING = 0.025  # half the width of the neck binding [m]
_FARTHEST = 0.55  # an armhole from the fingertips it lies ready for; the other one is 0.8 away [m]
_REACH = 0.35  # pieces of one ring are not farther than this from its largest piece [m]


def sleeve_opening(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
    """Find the armhole nearest to a point and the middle of its rim on the shoulder's side.

    The armhole's upper edge, along the strap that will be the shoulder seam, is what has to travel up the arm, so
    its middle is taken.  Where the neck binding, whose end marks that edge, is hidden, the middle of what is seen
    of the ring is taken, with little confidence.

    Args:
        frame: a view of the gown lying on the person.
        side: the wearer's sleeve that is meant, for the name of the target.
        near_in_map: (3,) roughly where it should be, such as below the tracked fingertips [m].

    Raises:
        PerceptionFailure: no armhole binding, or none near the point.
    """
    labels = gown_labels(frame)
    cloud = points_in_map(frame)
    rows, columns = np.nonzero((labels == Surface.ARMHOLE) & (frame.depth > 0))
    if len(rows) < 15:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "binding of an armhole")
    points = cloud[rows, columns]
    piece = clusters(points, 0.025)
    pieces = [np.flatnonzero(piece == k) for k in range(piece.max() + 1)]
    pieces = [p for p in pieces if len(p) >= 8]
    distances = [np.linalg.norm(points[p].mean(axis=0) - near_in_map) for p in pieces]
    if not pieces or min(distances) > _FARTHEST:
        raise PerceptionFailure(Problem.OUT_OF_REACH, f"binding of the {side} armhole")
    seed = points[pieces[int(np.argmin(distances))]].mean(axis=0)
    ring = np.concatenate([p for p in pieces if np.linalg.norm(points[p].mean(axis=0) - seed) < _REACH / 2 + 0.05])
    ring_points = points[ring]
    position, edge, confidence = _strap_edge(labels, cloud, ring_points)
    around = ring_points[np.linalg.norm(ring_points - position, axis=1) < 0.06]
    normal = surface_normal(around if len(around) >= 8 else ring_points, frame.pose_camera_in_map[:3, 3])
    low, high = np.percentile(ring_points, (5, 95), axis=0)
    return SleeveOpening(
        stamp=frame.stamp,
        confidence=confidence,
        target=SLEEVE_OF[side],
        position_in_map=position,
        approach_in_map=-normal,
        closing_in_map=across(edge, -normal),
        ring_points_in_map=ring_points,
        centre_in_map=(low + high) / 2,
    )


def _strap_edge(labels: np.ndarray, cloud: np.ndarray, ring: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Middle (3,) of the ring's upper edge, direction (3,) of that edge, and the confidence in it.

    The neck binding ends at the armhole's inner upper corner, and the strap continues its line.  The
    sleeve mostly lies folded over that edge, so its middle is not the middle of what is seen: it is half
    an armhole's width from the corner along the strap, which may bend down over the edge of the bed.
    """
    from scipy.spatial import KDTree

    seen = np.isfinite(cloud[..., 2])
    navy = cloud[(labels == Surface.COLLAR) & seen]
    navy = navy[:: len(navy) // 1000 + 1]
    near = KDTree(ring).query(navy)[0] if len(navy) >= 8 else np.array([np.inf])
    if near.min() > 0.12:  # the neck binding is hidden: the part of the ring seen is all there is
        return np.median(ring, axis=0), main_direction(ring), 0.2
    end = np.median(navy[near <= max(0.03, float(near.min()) + 0.02)], axis=0)
    binding = navy[np.linalg.norm(navy - end, axis=1) < 0.20]
    outward = main_direction(binding)
    if outward @ (end - np.median(navy, axis=0)) < 0:
        outward = -outward
    along = (binding - end) @ outward
    tip = np.median(binding[along >= np.percentile(along, 92)], axis=0)
    confidence = float(np.clip(1.0 - near.min() / 0.10, 0.2, 1.0))
    lower = np.median(ring, axis=0) - tip
    lower[2] = 0.0
    lower = unit(lower - (lower @ outward) * outward)
    strap = _follow(cloud[(labels != Surface.OTHER) & (labels != Surface.CUFF) & seen], tip, outward, lower)
    if strap is not None:
        return strap + _HALF_BINDING * lower, unit(strap - tip), confidence
    return tip + _HALF_WIDTH * outward + _HALF_BINDING * lower, outward, 0.6 * confidence


def _follow(gown: np.ndarray, tip: np.ndarray, outward: np.ndarray, lower: np.ndarray) -> np.ndarray | None:
    """The point (3,) half an armhole's width from `tip` along the strap's surface, None where it is hidden."""
    offset = gown - tip
    slab = (np.abs(offset @ lower) < 0.03) & (np.linalg.norm(offset, axis=1) < 0.16) & (offset @ outward > -0.02)
    slab &= offset[:, 2] < 0.03  # the strap may fall off, what rises is the sleeve
    strap = gown[slab]
    if len(strap) < 10:
        return None
    along = geodesic(strap, int(np.argmin(np.linalg.norm(strap - tip, axis=1))), 0.025)
    there = (along > _HALF_WIDTH - 0.015) & (along < _HALF_WIDTH + 0.015)
    if there.sum() < 4:
        return None
    headmost = (strap @ lower) <= np.percentile(strap[there] @ lower, 60)
    return np.median(strap[there & headmost], axis=0)

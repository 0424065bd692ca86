"""The strap of an armhole by its two borders: the armhole's rim on one side, the gown's edge on the other.

It needs no end of the neck binding, which hides in a fold as soon as the other arm is dressed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..image.cloud import clusters, points_in_map, surface_normal, thinned, unit
from ..image.garment import gown_labels
from ..image.surfaces import GOWN_SURFACES, Surface

AROUND = 0.25  # how far from the expected place to look [m]
_BORDER = (0.012, 0.048)  # points of the strap are that far from either border; it is 0.055 wide [m]
_WIDEST = 0.085  # from border to border, where the cloth is curved [m]
HALF_LENGTH = 0.082  # from the end of the neck binding to the middle of the strap [m]
_ELSEWHERE = 0.10  # a strip whose place is that wrong, as seen from the neck binding, is a side panel's [m]
_HEADWARD = 0.2  # the edge is headward of the rim: greatest share of the way across that leads to the feet
_GRIPPER = 0.03  # what is nearer to the camera by this stands in front of the gown [m]
_FEWEST = 12


class Strap(NamedTuple):
    """A strap between its borders.

    Attributes:
        middle: (3,) [m].
        across: (3,) unit vector from the rim to the edge.
        normal: (3,) unit vector off the side that is seen, towards the camera.
        rim: (n, 3) points of the armhole beside it [m].
        inside: whether it lies with the gown's inside up, folded over.
        points: how many points of it were seen.
    """

    middle: np.ndarray
    across: np.ndarray
    normal: np.ndarray
    rim: np.ndarray
    inside: bool
    points: int


def strap_between(frame: Frame, near_in_map: np.ndarray) -> Strap:
    """Find the strip of gown between an armhole's rim and the gown's edge.

    Args:
        frame: a view from close by, such as a hand camera's.
        near_in_map: (3,) roughly where the armhole is [m].

    Raises:
        PerceptionFailure: no rim near the place, or nothing between it and an edge.
    """
    from scipy.spatial import KDTree

    labels, cloud = gown_labels(frame), points_in_map(frame)
    near = np.nan_to_num(np.linalg.norm(cloud - near_in_map, axis=2), nan=np.inf) < AROUND
    rim = thinned(cloud[(labels == Surface.ARMHOLE) & near])
    if len(rim) < 15:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "rim of the armhole")
    rim = rim[clusters(rim, 0.03) == 0]
    edge = cloud[_edge(frame, labels) & near]
    plain = np.isin(labels, (Surface.OUTSIDE, Surface.INSIDE, Surface.COLLAR)) & near
    gown, sides = thinned(cloud[plain], 4000), thinned(labels[plain], 4000)
    if len(edge) < _FEWEST or len(gown) < _FEWEST:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "edge of the gown beside the armhole")
    (to_rim, at_rim), (to_edge, at_edge) = KDTree(rim).query(gown), KDTree(edge).query(gown)
    span = edge[at_edge] - rim[at_rim]
    width = np.linalg.norm(span, axis=1)
    low, high = _BORDER
    strip = (to_rim > low) & (to_rim < high) & (to_edge > low) & (to_edge < high)
    strip &= (width < _WIDEST) & (span[:, 1] < _HEADWARD * width)
    if strip.sum() < _FEWEST:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "strap between the armhole's rim and the gown's edge")
    points, span, sides = gown[strip], span[strip] / width[strip, None], sides[strip]
    largest = clusters(points, 0.02) == 0
    points, span, sides = points[largest], span[largest], sides[largest]
    navy = thinned(cloud[(labels == Surface.COLLAR) & near], 500)
    middle = np.median(points, axis=0)
    if len(navy) >= 20:
        off = np.abs(KDTree(navy).query(points)[0] - HALF_LENGTH)
        if off.min() > _ELSEWHERE:
            raise PerceptionFailure(Problem.OUT_OF_REACH, "strap beside the end of the neck binding")
        middle = np.median(points[off <= np.percentile(off, 25)], axis=0)
    normal = surface_normal(gown[np.linalg.norm(gown - middle, axis=1) < 0.03], frame.pose_camera_in_map[:3, 3])
    across = unit(np.median(span, axis=0))
    around = sides[np.linalg.norm(points - middle, axis=1) < 0.03]
    inside = bool((around == Surface.INSIDE).sum() > (around == Surface.OUTSIDE).sum())
    return Strap(middle, unit(across - (across @ normal) * normal), normal, rim, inside, len(points))


def _edge(frame: Frame, labels: np.ndarray) -> np.ndarray:
    """Pixels (H, W) of gown beside something behind it that is not gown; not where a gripper stands in front."""
    import cv2

    gown = np.isin(labels, GOWN_SURFACES)
    filled = cv2.morphologyEx(gown.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((9, 9), np.uint8)) > 0
    depth = np.where(frame.depth > 0, frame.depth, 9.0)
    beyond = cv2.dilate(np.where(filled, 0.0, depth).astype(np.float32), np.ones((7, 7), np.uint8))
    before = cv2.erode(np.where(filled, 9.0, depth).astype(np.float32), np.ones((9, 9), np.uint8))
    return gown & (beyond > frame.depth - 0.012) & (before > frame.depth - _GRIPPER)

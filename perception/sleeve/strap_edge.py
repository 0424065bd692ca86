"""The strap of an armhole by its two borders: the armhole's tape on one side, the gown's edge on the other.

The end of the neckline, which would tell as much, hides in a fold as soon as the other arm is dressed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..gown.gown_facts import GOWN
from ..image.cloud import clusters, surface_normal, thinned, unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES, Surface


@dataclass(frozen=True, kw_only=True)
class StrapEdgeTuning(Quantities):
    """Numbers of the search for a strap between its borders."""

    search_radius: float = quantity(0.25, "m", "around the expected place", "choice: a sleeve's length")
    min_armhole_points: int = quantity(15, "1", "of the armhole's tape", "choice: fewer are noise")
    armhole_step: float = quantity(0.03, "m", "between neighbours of one piece of that tape", "choice: half its width")
    max_points: int = quantity(4000, "1", "of the gown that are worked on", "choice: bounds the computing time")
    min_points: int = quantity(12, "1", "of the gown, of its edge and of the strap", "choice: fewer are noise")
    border_distance: tuple[float, float] = quantity(
        (0.012, 0.048), "m", "of a strap's points from either border", "choice: inside of its width of 0.055 m"
    )
    max_width: float = quantity(0.085, "m", "from border to border", "choice: above 0.055 m where the cloth is curved")
    max_footward: float = quantity(
        0.2,
        "1",
        "of the way from armhole to edge that leads to the feet",
        "choice: the edge is headward of the armhole",
    )
    strap_step: float = quantity(0.02, "m", "between neighbours on one strap", "choice: below the strap's width")
    max_neckline_points: int = quantity(500, "1", "that are worked on", "choice: bounds the computing time")
    min_neckline_points: int = quantity(
        20, "1", "from which its end tells the strap's middle", "choice: fewer are noise"
    )
    max_middle_error: float = quantity(
        0.10, "m", "of a strap's place, as seen from the neckline's end", "choice: beyond, it is a side panel's edge"
    )
    middle_percentile: float = quantity(
        25.0, "%", "of the points, nearest to that place, are its middle", "choice: steady"
    )
    normal_distance: float = quantity(
        0.03, "m", "from the middle, of cloth that tells its normal", "choice: half a width"
    )
    fill_size: int = quantity(
        9, "px", "of gaps in the gown's mask", "choice: as of depth noise and thin things before it"
    )
    beyond_size: int = quantity(
        7, "px", "around a pixel of edge, in which something lies behind", "choice: three pixels off"
    )
    front_size: int = quantity(
        9, "px", "around a pixel of edge, in which nothing stands before", "choice: four pixels off"
    )
    beyond_depth: float = quantity(
        0.012, "m", "before the gown, from which a thing counts as behind", "choice: depth noise"
    )
    front_depth: float = quantity(
        0.03,
        "m",
        "nearer to the camera than the gown, from which a thing is a gripper before it",
        "choice: depth noise",
    )
    no_depth: float = quantity(9.0, "m", "that stands for no depth", "choice: farther than every thing in a room")


DEFAULT = StrapEdgeTuning()


class Strap(NamedTuple):
    """A strap between its borders.

    Attributes:
        middle: (3,) [m].
        across: (3,) unit vector from the armhole to the edge.
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


def strap_between(frame: Frame, near_in_map: np.ndarray, tuning: StrapEdgeTuning = DEFAULT) -> Strap:
    """Find the strip of gown between an armhole's tape and the gown's edge.

    Args:
        frame: a view from close by, such as a hand camera's.
        near_in_map: (3,) roughly where the armhole is [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: no armhole near the place, or nothing between it and an edge.
    """
    from scipy.spatial import KDTree

    labels, cloud = gown_labels(frame), points_in_map(frame)
    near = np.nan_to_num(np.linalg.norm(cloud - near_in_map, axis=2), nan=np.inf) < tuning.search_radius
    rim = thinned(cloud[(labels == Surface.ARMHOLE) & near])
    if len(rim) < tuning.min_armhole_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "rim of the armhole")
    rim = rim[clusters(rim, tuning.armhole_step) == 0]
    edge = cloud[_edge(frame, labels, tuning) & near]
    plain = np.isin(labels, (Surface.OUTSIDE, Surface.INSIDE, Surface.COLLAR)) & near
    gown, sides = (thinned(of[plain], tuning.max_points) for of in (cloud, labels))
    if min(len(edge), len(gown)) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "edge of the gown beside the armhole")
    (to_rim, at_rim), (to_edge, at_edge) = KDTree(rim).query(gown), KDTree(edge).query(gown)
    span = edge[at_edge] - rim[at_rim]
    width = np.linalg.norm(span, axis=1)
    low, high = tuning.border_distance
    strip = (to_rim > low) & (to_rim < high) & (to_edge > low) & (to_edge < high)
    strip &= (width < tuning.max_width) & (span[:, 1] < tuning.max_footward * width)
    if strip.sum() < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "strap between the armhole's rim and the gown's edge")
    points, span, sides = gown[strip], span[strip] / width[strip, None], sides[strip]
    largest = clusters(points, tuning.strap_step) == 0
    points, span, sides = points[largest], span[largest], sides[largest]
    navy = thinned(cloud[(labels == Surface.COLLAR) & near], tuning.max_neckline_points)
    middle = np.median(points, axis=0)
    if len(navy) >= tuning.min_neckline_points:
        off = np.abs(KDTree(navy).query(points)[0] - GOWN.strap_half_length)
        if off.min() > tuning.max_middle_error:
            raise PerceptionFailure(Problem.OUT_OF_REACH, "strap beside the end of the neck binding")
        middle = np.median(points[off <= np.percentile(off, tuning.middle_percentile)], axis=0)
    patch = gown[np.linalg.norm(gown - middle, axis=1) < tuning.normal_distance]
    normal = surface_normal(patch, frame.pose_camera_in_map[:3, 3])
    across = unit(np.median(span, axis=0))
    around = sides[np.linalg.norm(points - middle, axis=1) < tuning.normal_distance]
    inside = bool((around == Surface.INSIDE).sum() > (around == Surface.OUTSIDE).sum())
    return Strap(middle, unit(across - (across @ normal) * normal), normal, rim, inside, len(points))


def _edge(frame: Frame, labels: np.ndarray, tuning: StrapEdgeTuning) -> np.ndarray:
    """Mask (H, W) of the gown's edge: beside it lies something that is not gown, behind it and not in front."""
    import cv2

    fill, beyond_size, front_size = (
        np.ones((size, size), np.uint8) for size in (tuning.fill_size, tuning.beyond_size, tuning.front_size)
    )
    gown = np.isin(labels, GOWN_SURFACES)
    filled = cv2.morphologyEx(gown.astype(np.uint8), cv2.MORPH_CLOSE, fill) > 0
    depth = np.where(frame.depth > 0, frame.depth, tuning.no_depth)
    beyond = cv2.dilate(np.where(filled, 0.0, depth).astype(np.float32), beyond_size)
    before = cv2.erode(np.where(filled, tuning.no_depth, depth).astype(np.float32), front_size)
    return gown & (beyond > frame.depth - tuning.beyond_depth) & (before > frame.depth - tuning.front_depth)

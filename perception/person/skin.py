"""The person on the bed as a camera sees them: bare skin, its head end, its trunk."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Head
from ..image.projection import points_in_map
from ..image.surfaces import Surface, surfaces

# Adult of 174 cm, lying on the back (Winter, Biomechanics of Human Movement, fig. 4.1: shares of body height) [m].
CROWN_TO_SHOULDER = 0.31
HEAD_HEIGHT = 0.173  # of the middle of what is seen of a lying head above the mattress
SHOULDER_HALF_WIDTH = 0.20
SHOULDER_ABOVE_BED = 0.10
TRUNK_HALF_WIDTH = 0.20


def skin_on_bed(frame: Frame, bed: np.ndarray, *, inner: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Skin on and above the bed.

    Args:
        frame: any view.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        inner: leave out points at the edge of the skin, whose pixels mix two depths.

    Returns:
        Points (n, 3) in the map [m] and the mask (H, W) of all skin.
    """
    import cv2

    skin = (surfaces(frame.rgb) == Surface.SKIN).astype(np.uint8)
    skin = cv2.morphologyEx(skin, cv2.MORPH_OPEN, np.ones((2, 2), np.uint8)) > 0
    taken = cv2.erode(skin.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0 if inner else skin
    cloud = points_in_map(frame)[taken]
    margin = np.array((0.45, 0.15, 0.0))  # an arm may reach over the edge of the bed
    low, high = bed[0] - margin, bed[1] + margin
    inside = np.isfinite(cloud[:, 2]) & (cloud[:, :2] > low[:2]).all(axis=1) & (cloud[:, :2] < high[:2]).all(axis=1)
    inside &= (cloud[:, 2] > bed[1, 2] - 0.15) & (cloud[:, 2] < bed[1, 2] + 0.75)
    return cloud[inside], skin


def head_seen(frame: Frame, bed: np.ndarray) -> Head:
    """Find the head: the skin at the head end of the bed (towards -y), as wide and as high as a head.

    Raises:
        PerceptionFailure: no skin at the head end, or the image cuts it off.
    """
    points, skin = skin_on_bed(frame, bed)
    if len(points) < 60:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "person")
    middle_of_bed = bed[:, 0].mean()
    candidates = points[(np.abs(points[:, 0] - middle_of_bed) < 0.30) & (points[:, 1] < bed[:, 1].mean() - 0.35)]
    if len(candidates) < 40:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "head")
    crown = float(np.percentile(candidates[:, 1], 0.5))
    blob = candidates[candidates[:, 1] < crown + 0.14]
    width = float(np.ptp(np.percentile(blob[:, 0], (2, 98))))
    height = float(np.percentile(blob[:, 2], 95)) - bed[1, 2]
    if not (0.08 < width < 0.30 and 0.10 < height < 0.35 and len(blob) >= 30):
        raise PerceptionFailure(Problem.NOTHING_SEEN, "head")
    cut = skin[0].any() or skin[:, 0].any() or skin[:, -1].any()
    confidence = min(1.0, len(blob) / 150) * (0.8 if cut else 1.0)
    middle = _centre_of_round(blob[blob[:, 1] > crown + 0.05])
    crown = _end_of_round(blob[blob[:, 1] < crown + 0.08], crown)
    return Head(
        stamp=frame.stamp,
        confidence=float(confidence),
        middle=middle,
        crown_in_map=np.array((middle, crown, float(np.median(blob[:, 2])))),
    )


def _centre_of_round(points: np.ndarray) -> float:
    """X of the centre of a round body along y, of which only the side towards the camera is seen (n, 3)."""
    x, z = points[:, 0], points[:, 2]
    plain = float(np.percentile(x, (3, 97)).mean())
    if len(points) < 20:
        return plain
    # x^2 + z^2 = 2 a x + 2 b z + c is linear in the centre (a, b)
    system = np.column_stack([2 * x, 2 * z, np.ones(len(x))])
    a, b, c = np.linalg.lstsq(system, x**2 + z**2, rcond=None)[0]
    radius = np.sqrt(max(c + a**2 + b**2, 0.0))
    return float(a) if 0.06 < radius < 0.13 and abs(a - plain) < 0.06 else plain


def _end_of_round(points: np.ndarray, seen: float) -> float:
    """Y of the far end of a ball of which the crown itself is turned away from the camera; `seen` is what shows [m]."""
    if len(points) < 20:
        return seen
    system = np.column_stack([2 * points, np.ones(len(points))])
    *centre, rest = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0]
    radius = np.sqrt(max(rest + float(np.square(centre).sum()), 0.0))
    end = float(centre[1] - radius)
    return end if 0.06 < radius < 0.13 and -0.08 < end - seen < 0.01 else seen

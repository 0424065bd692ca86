"""What is between the fingers: is there cloth, and how many layers of it.

Thin cloth does not hold the fingers open measurably, so both questions are answered from an image of the
cloth just below the fingertips.
"""

from __future__ import annotations

import numpy as np

from ..sim.world import Frame, Side
from .cloud import points_in_map, project
from .colours import GOWN_SURFACES, Surface, surfaces
from .errors import PerceptionFailure, Problem
from .estimates import Estimate, LayerCount

_NEAR = 0.045  # cloth held by the fingers is this close to the point between them [m]
_RADII = (0.035, 0.045, 0.055, 0.065)  # arcs around the fingertips along which sheets are counted [m]
_STEP = 0.012  # depth step from one sheet to the next [m]
_WIDTH = 0.006  # narrower pieces of an arc are noise [m]


def _gown_near(frame: Frame, pose_hand_in_map: np.ndarray, what: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Surface labels (H, W) of the gown, cloud (H, W, 3) and the fingertips' (u, v, z) in the image."""
    height, width = frame.depth.shape
    tip = project(frame, pose_hand_in_map[:3, 3])[0]
    if not (tip[2] > 0.02 and 0 <= tip[0] < width and 0 <= tip[1] < height):
        raise PerceptionFailure(Problem.OUT_OF_REACH, what)
    if not (frame.depth > 0).any():
        raise PerceptionFailure(Problem.NO_DEPTH, what)
    labels = surfaces(frame.rgb)
    return np.where(np.isin(labels, GOWN_SURFACES), labels, Surface.OTHER), points_in_map(frame), tip


def gripped_cloth(frame: Frame, pose_hand_in_map: np.ndarray) -> Estimate:
    """How sure it is that the fingers hold cloth: confidence 0 (nothing there) to 1.

    Args:
        frame: any view of the fingertips.
        pose_hand_in_map: (4, 4) of the hand, from the joint angles.

    Raises:
        PerceptionFailure: the fingertips are outside the image or there is no depth at all.
    """
    labels, cloud, tip = _gown_near(frame, pose_hand_in_map, "fingertips")
    with np.errstate(invalid="ignore"):
        near = (labels != Surface.OTHER) & (np.linalg.norm(cloud - pose_hand_in_map[:3, 3], axis=2) < _NEAR)
    disc = np.pi * (_NEAR * frame.intrinsics[0] / tip[2]) ** 2
    # a pinched corner covers about a tenth of the disc around the fingertips, the fingers cover most of the rest
    return Estimate(stamp=frame.stamp, confidence=float(min(1.0, near.sum() / (0.06 * disc))))


def layers(frame: Frame, side: Side, pose_hand_in_map: np.ndarray) -> LayerCount:
    """Count the sheets of cloth that leave the fingertips: 0, 1 or 2 (two or more).

    Along arcs around the fingertips, a new sheet begins at a gap, at a step in depth, or where the printed
    outside meets the plain inside without a binding between them, which is a fold.  A sheet hidden exactly
    behind another is not seen, so one layer is never certain; several views settle more than one.

    Args:
        frame: a view of the fingertips, from the side or from the hand.
        side: which hand.
        pose_hand_in_map: (4, 4) of the hand, from the joint angles.

    Raises:
        PerceptionFailure: the fingertips are outside the image or there is no depth at all.
    """
    labels, cloud, tip = _gown_near(frame, pose_hand_in_map, "fingertips")
    height, width = frame.depth.shape
    fingers = pose_hand_in_map[:3, 3]
    counts = []
    for radius in _RADII:
        pixels = radius * frame.intrinsics[0] / tip[2]
        angles = np.arange(0, 2 * np.pi, 1.0 / max(pixels, 1.0))
        u = np.round(tip[0] + pixels * np.cos(angles)).astype(int)
        v = np.round(tip[1] + pixels * np.sin(angles)).astype(int)
        inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
        label = np.full(len(angles), Surface.OTHER, dtype=np.uint8)
        away = np.full(len(angles), np.inf)
        label[inside] = labels[v[inside], u[inside]]
        away[inside] = np.linalg.norm(cloud[v[inside], u[inside]] - fingers, axis=1)
        depth = np.zeros(len(angles))
        depth[inside] = frame.depth[v[inside], u[inside]]
        label[~(away < 2.2 * radius + 0.02)] = Surface.OTHER  # cloth far behind the fingers is not held by them
        counts.append(_sheets(label, depth, max(2, round(_WIDTH * frame.intrinsics[0] / tip[2]))))
    seen = np.minimum(counts, 2)
    best = int(np.round(np.median(seen)))
    agreement = float((seen == best).mean())
    return LayerCount(stamp=frame.stamp, confidence=agreement * (0.6 if best == 1 else 0.8), side=side, layers=best)


def _sheets(label: np.ndarray, depth: np.ndarray, narrowest: int) -> int:
    """Sheets along one closed arc of surface labels (n,) and depths (n,) [m]."""
    cloth = label != Surface.OTHER
    if not cloth.any():
        return 0
    start = int(np.argmin(cloth))  # begin the walk in a gap, if there is one
    label, depth = np.roll(label, -start), np.roll(depth, -start)
    count, run, last_depth, last_side = 0, 0, 0.0, None
    for surface, z in zip(label, depth, strict=True):
        if surface == Surface.OTHER:
            count += run >= narrowest
            run, last_side = 0, None
            continue
        side = surface if surface in (Surface.OUTSIDE, Surface.INSIDE) else None
        step = run > 0 and z > 0 and last_depth > 0 and abs(z - last_depth) > _STEP
        fold = side is not None and last_side is not None and side != last_side
        if step or fold:
            count += run >= narrowest
            run = 0
        run += 1
        last_depth = z or last_depth
        last_side = side if side is not None else last_side
    return count + (run >= narrowest)

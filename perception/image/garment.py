"""Where the gown is in the image, and which of its sides is seen."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GownSide
from .surfaces import GOWN_SURFACES, Surface, surfaces

_SMALLEST = 0.0012  # share of the image below which a patch is noise


def gown_labels(frame: Frame) -> np.ndarray:
    """(H, W) uint8 `Surface` of every gown pixel, `OTHER` elsewhere; small patches are dropped.

    Raises:
        PerceptionFailure: no gown (`NOTHING_SEEN`), or it has no depth anywhere (`NO_DEPTH`).
    """
    import cv2

    labels = surfaces(frame.rgb)
    cloth = np.isin(labels, GOWN_SURFACES).astype(np.uint8)
    closed = cv2.morphologyEx(cloth, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    count, patches, stats, _ = cv2.connectedComponentsWithStats(closed, connectivity=8)
    smallest = max(20, _SMALLEST * labels.size)
    large = [k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] >= smallest]
    if not large:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "gown")
    keep = np.isin(patches, large) & (cloth > 0)
    if not (frame.depth[keep] > 0).any():
        raise PerceptionFailure(Problem.NO_DEPTH, "gown")
    return np.where(keep, labels, Surface.OTHER).astype(np.uint8)


def gown_side(frame: Frame) -> GownSide:
    """Which side of the gown faces the camera, by the area of printed and plain fabric.

    Raises:
        PerceptionFailure: no fabric is seen.
    """
    labels = gown_labels(frame)
    outside, inside = int((labels == Surface.OUTSIDE).sum()), int((labels == Surface.INSIDE).sum())
    if outside + inside < 50:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "fabric of the gown")
    return GownSide(stamp=frame.stamp, confidence=abs(outside - inside) / (outside + inside), outside=outside > inside)

"""Where the gown is in the image, and which of its sides is seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import GownSide
from .surfaces import GOWN_SURFACES, Surface, surfaces


@dataclass(frozen=True, kw_only=True)
class GarmentTuning(Quantities):
    """Numbers of the gown's pixels and of its side."""

    min_patch_share: float = quantity(0.0012, "1", "of the picture that a patch of gown fills", "choice: less is noise")
    min_patch_pixels: int = quantity(20, "1", "of a patch of gown, in small pictures", "choice: less is noise")
    closing_size: int = quantity(3, "px", "of gaps between pixels of one patch", "choice: single pixels of noise")
    min_tape_pixels: int = quantity(
        30,
        "1",
        "of the armholes' and cuffs' tapes, from which a gown has tapes",
        "measured: at the rail and before it, none in 144 pictures of plain and printed gowns and of random looks; the "
        "half of 48 of taped ones show 1200 and more (177, 180)",
    )
    min_fabric_pixels: int = quantity(50, "1", "of fabric from which the side is told", "choice: less is an edge")


DEFAULT = GarmentTuning()


def gown_labels(frame: Frame, tuning: GarmentTuning = DEFAULT) -> np.ndarray:
    """(H, W) uint8 `Surface` of every gown pixel, `OTHER` elsewhere; small patches are dropped.

    Raises:
        PerceptionFailure: no gown (`NOTHING_SEEN`), or it has no depth anywhere (`NO_DEPTH`).
    """
    import cv2

    labels = surfaces(frame.rgb)
    cloth = np.isin(labels, GOWN_SURFACES).astype(np.uint8)
    closed = cv2.morphologyEx(cloth, cv2.MORPH_CLOSE, np.ones((tuning.closing_size, tuning.closing_size), np.uint8))
    count, patches, stats, _ = cv2.connectedComponentsWithStats(closed, connectivity=8)
    smallest = max(tuning.min_patch_pixels, tuning.min_patch_share * labels.size)
    large = [k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] >= smallest]
    if not large:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "gown")
    keep = np.isin(patches, large) & (cloth > 0)
    if not (frame.depth[keep] > 0).any():
        raise PerceptionFailure(Problem.NO_DEPTH, "gown")
    return np.where(keep, labels, Surface.OTHER).astype(np.uint8)


def tapes_show(frame: Frame, tuning: GarmentTuning = DEFAULT) -> bool:
    """Whether the gown in the picture has tapes in the colours that the rules know; no gown has none."""
    try:
        labels = gown_labels(frame, tuning)
    except PerceptionFailure:
        return False
    return int(np.isin(labels, (Surface.ARMHOLE, Surface.CUFF)).sum()) >= tuning.min_tape_pixels


def gown_side(frame: Frame, tuning: GarmentTuning = DEFAULT) -> GownSide:
    """Which side of the gown faces the camera, by the area of printed and plain fabric.

    Raises:
        PerceptionFailure: no fabric is seen.
    """
    labels = gown_labels(frame, tuning)
    outside, inside = int((labels == Surface.OUTSIDE).sum()), int((labels == Surface.INSIDE).sum())
    if outside + inside < tuning.min_fabric_pixels:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "fabric of the gown")
    return GownSide(stamp=frame.stamp, confidence=abs(outside - inside) / (outside + inside), outside=outside > inside)

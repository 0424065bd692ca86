"""Every pixel to a surface, by hue and saturation.

Assumption (the same as in `sim.render.appearance`): a light blue gown, printed outside and plain inside, with navy tape
along its neckline, magenta around its armholes and green at its cuffs; bare skin.  A learned segmentation replaces this
file and nothing else.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ..gown.gown_facts import GOWN


class Surface(enum.IntEnum):
    """What a pixel shows."""

    OTHER = 0
    OUTSIDE = 1
    INSIDE = 2
    COLLAR = 3
    ARMHOLE = 4
    CUFF = 5
    SKIN = 6


GOWN_SURFACES = (Surface.OUTSIDE, Surface.INSIDE, Surface.COLLAR, Surface.ARMHOLE, Surface.CUFF)


@dataclass(frozen=True, kw_only=True)
class SurfaceTuning(Quantities):
    """Numbers of the segmentation, beside the colours of the gown."""

    skin_colour: tuple[float, float, float, float, float] = quantity(
        (5.0, 38.0, 0.30, 0.60, 0.12),
        "degree, degree, 1, 1, 1",
        "hue from, hue to, saturation from, saturation to, lowest value: bare skin",
        "choice: room for 10 degrees of hue, for light from dim to bright and for the camera's noise",
    )
    blur_size: int = quantity(3, "px", "of the median filter", "choice: takes out the noise of single pixels")


DEFAULT = SurfaceTuning()


def surfaces(rgb: np.ndarray, tuning: SurfaceTuning = DEFAULT) -> np.ndarray:
    """Label every pixel.

    Args:
        rgb: (H, W, 3) uint8.
        tuning: numbers of the segmentation.

    Returns:
        (H, W) uint8 of `Surface` values.
    """
    return _labelled(_smooth_hsv(rgb, tuning), tuning)


def _smooth_hsv(rgb: np.ndarray, tuning: SurfaceTuning) -> np.ndarray:
    """Hue in half degrees, saturation and value from 0 to 255, (H, W, 3) uint8, without the noise of single pixels."""
    import cv2

    return cv2.cvtColor(cv2.medianBlur(np.ascontiguousarray(rgb), tuning.blur_size), cv2.COLOR_RGB2HSV)


def _labelled(hsv: np.ndarray, tuning: SurfaceTuning) -> np.ndarray:
    import cv2

    labels = np.zeros(hsv.shape[:2], dtype=np.uint8)
    for surface, (h0, h1, s0, s1, v0) in (  # later ones win
        (Surface.INSIDE, GOWN.inside_colour),
        (Surface.OUTSIDE, GOWN.outside_colour),
        (Surface.COLLAR, GOWN.neckline_colour),
        (Surface.ARMHOLE, GOWN.armhole_colour),
        (Surface.CUFF, GOWN.cuff_colour),
        (Surface.SKIN, tuning.skin_colour),
    ):
        band = cv2.inRange(hsv, (h0 / 2, 255 * s0, 255 * v0), (h1 / 2, 255 * s1, 255))
        labels[band > 0] = surface
    return labels


def surfaces_at(rgb: np.ndarray, rows: np.ndarray, columns: np.ndarray, tuning: SurfaceTuning = DEFAULT) -> np.ndarray:
    """Label some pixels as `surfaces` does, for less than the whole picture costs.

    Args:
        rgb: (H, W, 3) uint8.
        rows: (n,) of the pixels, at least one.
        columns: (n,) of the pixels.
        tuning: numbers of the segmentation.

    Returns:
        (n,) uint8 of `Surface` values.
    """
    room = tuning.blur_size // 2
    top, left = max(rows.min() - room, 0), max(columns.min() - room, 0)
    window = rgb[top : rows.max() + room + 1, left : columns.max() + room + 1]
    return _labelled(_smooth_hsv(window, tuning)[rows - top, columns - left][:, None], tuning)[:, 0]

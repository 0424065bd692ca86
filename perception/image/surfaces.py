"""Every pixel to a surface, by hue and saturation.

Assumption (the same as in `sim.appearance`): navy neck binding, magenta armhole bindings, green cuffs, a light blue
gown printed outside and plain inside, bare skin.  The bands below leave room for about 10 degrees of hue, for
light between dim and bright and for the camera's noise; a learned segmentation replaces this file and nothing else.
"""

from __future__ import annotations

import enum

import numpy as np


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

# surface -> hue from, to [degrees], saturation from, to, lowest value; later rows win
_BANDS: tuple[tuple[Surface, float, float, float, float, float], ...] = (
    (Surface.INSIDE, 188, 230, 0.125, 0.32, 0.26),
    (Surface.OUTSIDE, 188, 230, 0.32, 0.60, 0.08),
    (Surface.COLLAR, 212, 250, 0.60, 1.00, 0.04),
    (Surface.ARMHOLE, 300, 346, 0.50, 1.00, 0.10),
    (Surface.CUFF, 115, 165, 0.48, 1.00, 0.10),
    (Surface.SKIN, 5, 38, 0.30, 0.60, 0.12),
)


def surfaces(rgb: np.ndarray) -> np.ndarray:
    """Label every pixel.

    Args:
        rgb: (H, W, 3) uint8.

    Returns:
        (H, W) uint8 of `Surface` values.
    """
    import cv2

    smooth = cv2.medianBlur(np.ascontiguousarray(rgb), 3)
    hsv = cv2.cvtColor(smooth, cv2.COLOR_RGB2HSV)  # hue in half degrees, the others 0-255
    labels = np.zeros(rgb.shape[:2], dtype=np.uint8)
    for surface, h0, h1, s0, s1, v0 in _BANDS:
        band = cv2.inRange(hsv, (h0 / 2, 255 * s0, 255 * v0), (h1 / 2, 255 * s1, 255))
        labels[band > 0] = surface
    return labels

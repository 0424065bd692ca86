"""The classical rules on what the network sees: skin repainted in the colour that those rules take for skin.

What the network takes for skin gets that colour; what the rules would take for skin, and the network for something
else, becomes grey: wood and walls have the colour of some skin.  So a person of any skin comes into the rules' reach,
as far as the network sees them.  Surfaces of the gown keep their colours: of its bindings the network tells too little
(an IoU of 0.43; the rules ask for 0.8), and it took the table of a washing cloth for a gown.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...sim.world import Frame
from ..image.surfaces import DEFAULT as SURFACES
from ..image.surfaces import Surface, surfaces


def repainted(frame: Frame, seen: np.ndarray) -> Frame:
    """A frame in which those pixels, and no others, have the colour of skin that are `seen` (H, W) as such."""
    rgb = np.array(frame.rgb)
    no_skin = (seen != Surface.SKIN) & (surfaces(rgb) == Surface.SKIN)
    rgb[no_skin] = rgb[no_skin].mean(axis=1, keepdims=True).astype(np.uint8)
    rgb[seen == Surface.SKIN] = _skin_colour()
    return replace(frame, rgb=rgb)


@lru_cache
def _skin_colour() -> np.ndarray:
    """(3,) uint8: the middle of the band of colours that the rules take for skin, as bright as may be."""
    import cv2

    h0, h1, s0, s1, _ = SURFACES.skin_colour
    hsv = np.array([[[(h0 + h1) / 4, 255 * (s0 + s1) / 2, 255]]]).round().astype(np.uint8)
    return cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB)[0, 0]

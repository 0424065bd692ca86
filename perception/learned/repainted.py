"""The classical rules on what the network sees: skin repainted in the colour that those rules take for skin.

What the network takes for skin gets that colour; what the rules would take for skin, and the network for something
else, becomes grey: wood and walls have the colour of some skin.  So a person of any skin comes into the rules' reach,
as far as the network sees them.  Surfaces of the gown keep their colours there: it took the table of a washing cloth
for a gown.  Where a gown is what is asked about, and shows no tapes, that is repainted too; of its bindings the network
tells half (an IoU of 0.49; the rules ask for 0.8).
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...sim.world import Frame
from ..gown.gown_facts import GOWN
from ..image.surfaces import DEFAULT as SURFACES
from ..image.surfaces import GOWN_SURFACES, Surface, surfaces


def repainted(frame: Frame, seen: np.ndarray) -> Frame:
    """A frame in which those pixels, and no others, have the colour of skin that are `seen` (H, W) as such."""
    rgb = np.array(frame.rgb)
    no_skin = (seen != Surface.SKIN) & (surfaces(rgb) == Surface.SKIN)
    rgb[no_skin] = rgb[no_skin].mean(axis=1, keepdims=True).astype(np.uint8)
    rgb[seen == Surface.SKIN] = _skin_colour()
    return replace(frame, rgb=rgb)


def gown_repainted(frame: Frame, seen: np.ndarray) -> Frame:
    """A frame in which those pixels, and no others, have the colours of a taped gown that are `seen` (H, W) as one."""
    rgb = np.array(frame.rgb)
    no_gown = np.isin(surfaces(rgb), GOWN_SURFACES) & ~np.isin(seen, GOWN_SURFACES)
    rgb[no_gown] = rgb[no_gown].mean(axis=1, keepdims=True).astype(np.uint8)
    for surface, colour in _gown_colours().items():
        rgb[seen == surface] = colour
    return replace(frame, rgb=rgb)


@lru_cache
def _gown_colours() -> dict[Surface, np.ndarray]:
    """Surface of the gown -> (3,) uint8, the middle of the band of colours that the rules take for it."""
    bands = {
        Surface.OUTSIDE: GOWN.outside_colour,
        Surface.INSIDE: GOWN.inside_colour,
        Surface.COLLAR: GOWN.neckline_colour,
        Surface.ARMHOLE: GOWN.armhole_colour,
        Surface.CUFF: GOWN.cuff_colour,
    }
    return {surface: _middle(band) for surface, band in bands.items()}


@lru_cache
def _skin_colour() -> np.ndarray:
    """(3,) uint8: the middle of the band of colours that the rules take for skin."""
    return _middle(SURFACES.skin_colour)


def _middle(band: tuple[float, float, float, float, float]) -> np.ndarray:
    """(3,) uint8: the middle of a band of hues [degree] and saturations, as bright as may be."""
    import cv2

    h0, h1, s0, s1, _ = band
    hsv = np.array([[[(h0 + h1) / 4, 255 * (s0 + s1) / 2, 255]]]).round().astype(np.uint8)
    return cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB)[0, 0]

"""Bare skin on and above the bed, as a camera sees it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..image.projection import points_in_map
from ..image.surfaces import Surface, surfaces


@dataclass(frozen=True, kw_only=True)
class SkinTuning(Quantities):
    """Numbers of what counts as the skin of the person on the bed."""

    margin: tuple[float, float] = quantity(
        (0.45, 0.15), "m", "across and along the bed, beyond its edge", "choice: an arm may reach over the edge"
    )
    height_range: tuple[float, float] = quantity(
        (-0.15, 0.75), "m", "above the mattress", "choice: a hand that hangs down, and an arm that is raised"
    )
    opening: int = quantity(2, "px", "of specks that are no skin", "choice: noise of the picture")
    edge: int = quantity(3, "px", "of the window whose edge pixels mix two depths", "choice: one pixel to each side")


DEFAULT = SkinTuning()


def skin_on_bed(
    frame: Frame, bed: np.ndarray, *, inner: bool = False, tuning: SkinTuning = DEFAULT
) -> tuple[np.ndarray, np.ndarray]:
    """Skin on and above the bed.

    Args:
        frame: any view.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        inner: leave out points at the edge of the skin, whose pixels mix two depths.
        tuning: numbers.

    Returns:
        Points (n, 3) in the map [m] and the mask (H, W) of all skin.
    """
    import cv2

    skin = (surfaces(frame.rgb) == Surface.SKIN).astype(np.uint8)
    speck = np.ones((tuning.opening, tuning.opening), np.uint8)
    # with its anchor at the other corner, as opening with an even window would move the mask by a pixel
    skin = cv2.dilate(cv2.erode(skin, speck), speck, anchor=(0, 0)) > 0
    taken = cv2.erode(skin.astype(np.uint8), np.ones((tuning.edge, tuning.edge), np.uint8)) > 0 if inner else skin
    cloud = points_in_map(frame)[taken]
    low, high = bed[0, :2] - tuning.margin, bed[1, :2] + tuning.margin
    inside = np.isfinite(cloud[:, 2]) & (cloud[:, :2] > low).all(axis=1) & (cloud[:, :2] < high).all(axis=1)
    lowest, highest = bed[1, 2] + np.array(tuning.height_range)
    inside &= (cloud[:, 2] > lowest) & (cloud[:, 2] < highest)
    return cloud[inside], skin

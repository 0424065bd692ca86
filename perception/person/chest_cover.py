"""How much of the person's chest and belly lies under the gown, as far as a camera sees them."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Cover
from ..image.garment import gown_labels
from ..image.projection import pixels_of
from ..image.surfaces import Surface

_WIDTH = np.linspace(-0.14, 0.14, 9)  # across the body from its midline [m]
_LENGTH = np.linspace(0.06, 0.48, 12)  # along it from the shoulders [m]
_HEIGHT = 0.22  # of the front of the trunk above the bed [m]
_FEWEST = 0.5  # share of the places that have to be in view


def chest_cover(frame: Frame, bed: np.ndarray, shoulders_in_map: np.ndarray) -> Cover:
    """Ask at a grid of places on the front of the trunk whether the camera sees gown there or something else.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed [m].
        shoulders_in_map: (3,) middle between the shoulders [m].

    Raises:
        PerceptionFailure: no gown in the image, or too little of the trunk in view.
    """
    labels = gown_labels(frame)
    across, along = np.meshgrid(_WIDTH, _LENGTH)
    places = np.column_stack(
        (
            shoulders_in_map[0] + across.ravel(),
            shoulders_in_map[1] + along.ravel(),
            np.full(across.size, bed[1, 2] + _HEIGHT),
        )
    )
    rows, columns, depth, inside = pixels_of(frame, places)
    rows, columns = rows[inside], columns[inside]
    seen = frame.depth[rows, columns]
    open_view = seen > depth[inside] - 0.15  # a robot's arm or a raised one may be in front
    if open_view.sum() < _FEWEST * len(places):
        raise PerceptionFailure(Problem.OUT_OF_REACH, "trunk of the person")
    covered = labels[rows, columns][open_view] != Surface.OTHER
    return Cover(stamp=frame.stamp, confidence=float(open_view.sum() / len(places)), share=float(covered.mean()))

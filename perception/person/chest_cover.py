"""How much of the person's chest and belly lies under the gown, as far as a camera sees them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import ChestCover
from ..image.garment import gown_labels
from ..image.projection import pixels_of
from ..image.surfaces import Surface
from .person_facts import PERSON


@dataclass(frozen=True, kw_only=True)
class ChestCoverTuning(Quantities):
    """Numbers of the grid of points on the front of the trunk."""

    half_width: float = quantity(0.14, "m", "of the grid, from the midline", "choice: the front, not the flanks")
    columns: int = quantity(9, "1", "of the grid", "choice: every 3.5 cm")
    length_range: tuple[float, float] = quantity(
        (0.06, 0.48), "m", "of the grid along the body from the shoulders", "choice: chest and belly"
    )
    rows: int = quantity(12, "1", "of the grid", "choice: every 3.8 cm")
    min_share: float = quantity(0.5, "1", "of the grid that has to be in view", "choice: half of it stands for all")
    hidden_distance: float = quantity(
        0.15, "m", "before the trunk, where something stands in between", "choice: a robot's arm or a raised one"
    )


DEFAULT = ChestCoverTuning()


def chest_cover(
    frame: Frame, bed: np.ndarray, shoulders_in_map: np.ndarray, tuning: ChestCoverTuning = DEFAULT
) -> ChestCover:
    """Ask at a grid of points on the front of the trunk whether the camera sees gown there or something else.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        shoulders_in_map: (3,) middle between the shoulders [m].
        tuning: numbers.

    Raises:
        PerceptionFailure: no gown in the image, or too little of the trunk in view.
    """
    labels = gown_labels(frame)
    across, along = np.meshgrid(
        np.linspace(-tuning.half_width, tuning.half_width, tuning.columns),
        np.linspace(*tuning.length_range, tuning.rows),
    )
    points = np.column_stack(
        (
            shoulders_in_map[0] + across.ravel(),
            shoulders_in_map[1] + along.ravel(),
            np.full(across.size, bed[1, 2] + PERSON.front_height),
        )
    )
    rows, columns, depth, inside = pixels_of(frame, points)
    rows, columns = rows[inside], columns[inside]
    open_view = frame.depth[rows, columns] > depth[inside] - tuning.hidden_distance
    if open_view.sum() < tuning.min_share * len(points):
        raise PerceptionFailure(Problem.OUT_OF_REACH, "trunk of the person")
    seen = labels[rows, columns][open_view]
    covered = seen[seen != Surface.OTHER]
    return ChestCover(
        stamp=frame.stamp,
        confidence=float(open_view.sum() / len(points)),
        share=len(covered) / len(seen),
        outside=float(np.mean(covered != Surface.INSIDE)) if len(covered) else 0.0,
    )

"""How high the front of the person's chest lies, as far as a camera sees it, bare or under the gown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import ChestFront
from ..image.projection import points_in_map


@dataclass(frozen=True, kw_only=True)
class ChestFrontTuning(Quantities):
    """Numbers of the cells into which the front of the chest is divided."""

    half_width: float = quantity(0.12, "m", "of the cells together, from the midline", "choice: the front, no flanks")
    columns: int = quantity(5, "1", "of cells across the body, of which one is on the midline", "choice: 5 cm wide")
    length_range: tuple[float, float] = quantity(
        (0.06, 0.42), "m", "of the cells together along the body from the shoulders", "choice: chest and belly"
    )
    rows: int = quantity(9, "1", "of cells along the body", "choice: 4 cm long")
    height_range: tuple[float, float] = quantity(
        (0.12, 0.30), "m", "above the mattress, of what may be a chest", "choice: adults; a robot's arm is higher"
    )
    min_share: float = quantity(0.6, "1", "of the cells that have to show", "choice: more than half stands for all")
    percentile: float = quantity(
        80.0, "%", "of the heights of a column's cells that counts as its height", "choice: the front, with no fold"
    )


DEFAULT = ChestFrontTuning()


def chest_front(
    frame: Frame, bed: np.ndarray, shoulders_in_map: np.ndarray, tuning: ChestFrontTuning = DEFAULT
) -> ChestFront:
    """Measure the heights of what shows on the front of the chest.

    Cloth lies on the chest, never below its skin: the front is at most as high as this says.

    Args:
        frame: a view of the person.
        bed: (2, 3) lower and upper corner of the bed in the map [m].
        shoulders_in_map: (3,) middle between the shoulders [m].
        tuning: numbers.

    Raises:
        PerceptionFailure: too little of the chest shows.
    """
    points = points_in_map(frame)
    across = (points[..., 0] - shoulders_in_map[0]) / tuning.half_width
    low, high = tuning.length_range
    along = (points[..., 1] - shoulders_in_map[1] - low) / (high - low)
    height = points[..., 2] - bed[1, 2]
    with np.errstate(invalid="ignore"):  # where there is no depth
        seen = (np.abs(across) < 1.0) & (along > 0.0) & (along < 1.0)
        seen &= (height > tuning.height_range[0]) & (height < tuning.height_range[1])
    column = ((across[seen] + 1.0) / 2.0 * tuning.columns).astype(int)
    row = (along[seen] * tuning.rows).astype(int)
    cells = np.full((tuning.columns, tuning.rows), np.nan)
    for c, r in np.unique(np.column_stack((column, row)), axis=0):
        cells[c, r] = np.median(height[seen][(column == c) & (row == r)])
    shows = np.isfinite(cells)
    if shows.mean() < tuning.min_share or not shows.any(axis=1).all():
        raise PerceptionFailure(Problem.OUT_OF_REACH, "chest of the person")
    heights = np.nanpercentile(cells, tuning.percentile, axis=1)
    return ChestFront(
        stamp=frame.stamp,
        confidence=float(shows.mean()),
        height=float(heights.max()),
        breastbone=float(heights[tuning.columns // 2]),
    )

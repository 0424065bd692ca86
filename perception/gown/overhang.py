"""How much of the gown lies beyond one edge of the bed: one with too much of it there slides off, once let go of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import Cover
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES


@dataclass(frozen=True, kw_only=True)
class OverhangTuning(Quantities):
    """Numbers of the gown beyond an edge of the bed."""

    min_points: int = quantity(200, "1", "of the gown", "choice: fewer do not tell")
    full_points: int = quantity(2000, "1", "of it that make it certain", "choice: half of one seen from beside the bed")


DEFAULT = OverhangTuning()


def overhang(frame: Frame, bed: np.ndarray, side: Side, tuning: OverhangTuning = DEFAULT) -> Cover:
    """The share of the gown, by the area that shows, beyond the edge of the bed on a side of the person.

    Args:
        frame: of any camera.
        bed: (2, 3) lower and upper corner of the mattress in the map [m].
        side: of the person.
        tuning: how much has to show.

    Raises:
        PerceptionFailure: too little of the gown shows.
    """
    shown = np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)
    if (count := int(shown.sum())) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "gown")
    across = points_in_map(frame)[shown][:, 0]
    beyond = across > bed[1, 0] if side == "right" else across < bed[0, 0]
    area = frame.depth[shown] ** 2  # that a pixel shows, but for the tilt of the cloth
    share = float(area[beyond].sum() / area.sum())
    return Cover(stamp=frame.stamp, confidence=min(1.0, count / tuning.full_points), share=share)

"""Whether a hand or an arm is inside a sleeve: skin that shows where it is says no."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Cover
from ..image.projection import pixels_of
from ..image.surfaces import Surface, surfaces_at


@dataclass(frozen=True, kw_only=True)
class SkinCoverTuning(Quantities):
    """Numbers of the look at a hand or an arm."""

    min_points: int = quantity(4, "1", "of its axis in view", "choice: fewer say little about a hand")


DEFAULT = SkinCoverTuning()


def skin_cover(frame: Frame, points_in_map: np.ndarray, tuning: SkinCoverTuning = DEFAULT) -> Cover:
    """Ask along the axis of a hand, or of an arm, whether the camera sees something else than skin there.

    In recorded pulls the share was 1 for a hand inside and at most 0.2 for one that the sleeve had missed.

    Args:
        frame: a view from close by; what stands between counts as a cover, so the view must be free.
        points_in_map: (n, 3) on its axis [m].
        tuning: numbers.

    Raises:
        PerceptionFailure: too few of the points are in view.
    """
    rows, columns, _, inside = pixels_of(frame, points_in_map)
    if inside.sum() < tuning.min_points:
        raise PerceptionFailure(Problem.OUT_OF_REACH, "hand or arm of the person")
    seen = surfaces_at(frame.rgb, rows[inside], columns[inside])
    return Cover(stamp=frame.stamp, confidence=float(inside.mean()), share=float((seen != Surface.SKIN).mean()))

"""Which way a held sleeve points: from its armhole's tape to its cuff's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SleeveHeading
from ..image.surfaces import Surface
from .held_armhole import held_tape


@dataclass(frozen=True, kw_only=True)
class SleeveHeadingTuning(Quantities):
    """Numbers of a held sleeve's heading."""

    min_points: int = quantity(15, "1", "of either tape", "choice: fewer are noise")
    full_points: int = quantity(60, "1", "of the smaller one that make it certain", "choice: seen from close by")
    extent: tuple[float, float] = quantity(
        (5.0, 95.0), "%", "of the points, which are its extent", "choice: leaves noise out"
    )


DEFAULT = SleeveHeadingTuning()


def sleeve_heading(
    frame: Frame, side: Side, near_in_map: np.ndarray, tuning: SleeveHeadingTuning = DEFAULT
) -> SleeveHeading:
    """Compare where the two tapes of a sleeve show around the grip.

    Args:
        frame: of any camera.
        side: the sleeve's.
        near_in_map: (3,) fingertips that hold the strap [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    armhole, cuff = (held_tape(frame, tape, near_in_map) for tape in (Surface.ARMHOLE, Surface.CUFF))
    fewest = min(len(armhole), len(cuff))
    if fewest < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the {side} sleeve")
    middles = [np.percentile(points, tuning.extent, axis=0).mean(axis=0) for points in (armhole, cuff)]
    return SleeveHeading(
        stamp=frame.stamp,
        confidence=min(1.0, fewest / tuning.full_points),
        side=side,
        cuff_from_armhole_in_map=middles[1] - middles[0],
    )

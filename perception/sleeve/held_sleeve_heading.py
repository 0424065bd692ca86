"""Which way a held sleeve points: from its armhole's binding to its cuff's."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SleeveHeading
from ..image.surfaces import Surface
from .held_armhole import POINTS, held_binding


def sleeve_heading(frame: Frame, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
    """Compare where the two bindings of a sleeve show around the grip.

    Args:
        frame: of any camera.
        side: the sleeve's.
        near_in_map: (3,) fingertips that hold the strap [m].

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    armhole, cuff = (held_binding(frame, binding, near_in_map) for binding in (Surface.ARMHOLE, Surface.CUFF))
    fewest = min(len(armhole), len(cuff))
    if fewest < POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the {side} sleeve")
    middles = [np.percentile(points, (5, 95), axis=0).mean(axis=0) for points in (armhole, cuff)]
    return SleeveHeading(
        stamp=frame.stamp, confidence=min(1.0, fewest / 60), side=side, cuff_from_armhole_in_map=middles[1] - middles[0]
    )

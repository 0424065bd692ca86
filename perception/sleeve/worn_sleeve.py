"""Where the bindings of a sleeve show along an arm that is, or is not, inside it."""

from __future__ import annotations

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import WornSleeve
from ..image.surfaces import Surface
from .cuff_round_arm import binding_near, share_round

_POINTS = 15


def worn_sleeve(frame: Frame, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
    """Where along the upper arm both bindings of its sleeve show, and how far round it the cuff does.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    shoulder, along = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    line = shoulder + np.outer((-1.0, 2.0), along)
    found = [binding_near(frame, binding, line) for binding in (Surface.ARMHOLE, Surface.CUFF)]
    if min(map(len, found)) < _POINTS:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
    armhole, cuff = (float(np.median((points - shoulder) @ along)) / float(along @ along) for points in found)
    return WornSleeve(
        stamp=frame.stamp,
        confidence=min(1.0, min(map(len, found)) / 100),
        side=side,
        armhole_at=armhole,
        cuff_at=cuff,
        round_arm=share_round(found[1], line),
    )

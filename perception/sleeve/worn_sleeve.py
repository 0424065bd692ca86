"""Where the tapes of a sleeve show along an arm that is, or is not, inside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import WornSleeve
from ..image.surfaces import Surface
from .armhole_reach import armhole_reach
from .cuff_round_arm import CuffTuning, share_round, tape_near


@dataclass(frozen=True, kw_only=True)
class WornSleeveTuning(Quantities):
    """Numbers of where a sleeve shows along an upper arm."""

    line: tuple[float, float] = quantity(
        (-1.0, 2.0), "1", "ends of the line beside which tape counts: 0 shoulder, 1 elbow", "choice: all of a sleeve"
    )
    min_points: int = quantity(15, "1", "of either tape", "choice: fewer are noise")
    full_points: int = quantity(100, "1", "of the smaller one that make it certain", "choice: seen from close by")
    fabric_near: float = quantity(
        0.12, "m", "of fabric between both tapes from the arm's axis", "choice: a loose sleeve's, not the gown's front"
    )
    fabric_part: float = quantity(0.8, "1", "of the way between both that is looked at", "choice: clear of both tapes")
    min_fabric: int = quantity(50, "1", "points of fabric that tell which side they show", "choice: fewer are noise")


DEFAULT = WornSleeveTuning()


def worn_sleeve(frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: WornSleeveTuning = DEFAULT) -> WornSleeve:
    """Where along the upper arm both tapes of its sleeve show, and how far round it the cuff does.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the search.

    Raises:
        PerceptionFailure: too little of either is seen.
    """
    shoulder, along = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    line = shoulder + np.outer(tuning.line, along)
    armhole, cuff = (tape_near(frame, tape, line) for tape in (Surface.ARMHOLE, Surface.CUFF))
    if min(len(armhole), len(cuff)) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"both bindings of the worn {side} sleeve")
    length = float(np.linalg.norm(along))
    armhole_at, cuff_at = (float(np.median((tape - shoulder) @ along)) / length**2 for tape in (armhole, cuff))
    return WornSleeve(
        stamp=frame.stamp,
        confidence=min(1.0, min(len(armhole), len(cuff)) / tuning.full_points),
        side=side,
        armhole_at=armhole_at,
        cuff_at=cuff_at,
        reach=armhole_reach(armhole, cuff, arm_in_map, frame.pose_camera_in_map[:3, 3]),
        round_arm=share_round(cuff, line),
        inside_out=_inside_out(frame, line, shoulder + np.outer((armhole_at, cuff_at), along), tuning),
    )


def _inside_out(frame: Frame, line: np.ndarray, between: np.ndarray, tuning: WornSleeveTuning) -> float:
    """Share of the fabric near a line (2, 3), between two places (2, 3) on it, that shows the gown's inside."""
    way = between[1] - between[0]
    counts = []
    for surface in (Surface.OUTSIDE, Surface.INSIDE):
        points = tape_near(frame, surface, line, CuffTuning(max_distance=tuning.fabric_near))
        share = (points - between[0]) @ way / (way @ way)
        counts.append(int((np.abs(share - 0.5) < 0.5 * tuning.fabric_part).sum()))
    return counts[1] / sum(counts) if sum(counts) >= tuning.min_fabric else 0.0

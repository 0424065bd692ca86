"""The highest part of a worn sleeve's armhole above an arm that lies: its front edge, where it is drawn up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from ..image.cloud import unit
from ..image.surfaces import Surface
from .cuff_round_arm import tape_near
from .on_top import grasp_on_top


@dataclass(frozen=True, kw_only=True)
class ArmholeFrontTuning(Quantities):
    """Numbers of where an armhole is highest above its arm."""

    line: tuple[float, float] = quantity(
        (-0.5, 1.5), "1", "ends of the line beside which tape counts: 0 shoulder, 1 elbow", "choice: all of an armhole"
    )
    half_width: float = quantity(
        0.18,
        "m",
        "aside of the arm's axis as seen from above, within which tape counts",
        "measured: in three recorded states the highest vertex of an armhole's edge lay 0.02 to 0.13 m from it, what "
        "shows of it from the head of the bed up to 0.16 m",
    )
    highest: float = quantity(
        0.2,
        "1",
        "share of the tape above the arm, its highest, that is taken for the front",
        "measured: its middle lay 0.02 to 0.06 m from that vertex",
    )
    patch: float = quantity(0.05, "m", "around the place, over which its normal is taken", "choice: one cell of cloth")
    min_points: int = quantity(10, "1", "of the tape there", "choice: fewer are noise")
    full_points: int = quantity(80, "1", "of the tape that make it certain", "choice: seen from close by")


DEFAULT = ArmholeFrontTuning()


def armhole_front(frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: ArmholeFrontTuning = DEFAULT) -> GraspPoint:
    """The front edge of a worn sleeve's armhole, where it is highest above the arm.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the search.

    Returns:
        The grasp in the map: into the cloth, and the fingers close along the arm.

    Raises:
        PerceptionFailure: too little of the armhole's tape is seen there.
    """
    shoulder, along = arm_in_map[0], unit(arm_in_map[1] - arm_in_map[0])
    line = shoulder + np.outer(tuning.line, arm_in_map[1] - arm_in_map[0])
    tape = tape_near(frame, Surface.ARMHOLE, line)
    off = tape - shoulder
    aside = unit(np.cross(along, (0.0, 0.0, 1.0)))
    above = off - np.outer(off @ along, along)
    near = (np.abs(off @ aside) < tuning.half_width) & (above[:, 2] > 0.0)
    if np.count_nonzero(near) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"front of the worn {side} sleeve's armhole")
    height = above[near, 2]
    return grasp_on_top(
        frame,
        side,
        tape[near],
        height,
        tape,
        aside,
        highest=tuning.highest,
        patch=tuning.patch,
        confidence=min(1.0, len(height) / tuning.full_points),
    )

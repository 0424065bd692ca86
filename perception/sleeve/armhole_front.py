"""Where the armhole of a worn sleeve crosses the top of an arm that lies: its front edge, where it is drawn up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import SLEEVE_OF, GraspPoint
from ..image.cloud import across, surface_normal, unit
from ..image.surfaces import Surface
from .cuff_round_arm import tape_near


@dataclass(frozen=True, kw_only=True)
class ArmholeFrontTuning(Quantities):
    """Numbers of where an armhole crosses the top of its arm."""

    line: tuple[float, float] = quantity(
        (-0.5, 1.5), "1", "ends of the line beside which tape counts: 0 shoulder, 1 elbow", "choice: all of an armhole"
    )
    half_width: float = quantity(
        0.035,
        "m",
        "aside of the arm's axis as seen from above, within which tape counts",
        "measured: in five recorded runs the middle of the front edge lay 0 to 2.6 cm from it",
    )
    patch: float = quantity(0.05, "m", "around the place, over which its normal is taken", "choice: one cell of cloth")
    min_points: int = quantity(10, "1", "of the tape there", "choice: fewer are noise")
    full_points: int = quantity(80, "1", "of the tape that make it certain", "choice: seen from close by")


DEFAULT = ArmholeFrontTuning()


def armhole_front(frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: ArmholeFrontTuning = DEFAULT) -> GraspPoint:
    """The front edge of a worn sleeve's armhole, where it crosses the top of the arm.

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
    top = tape[(np.abs(off @ aside) < tuning.half_width) & (above[:, 2] > 0.0)]
    if len(top) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"front of the worn {side} sleeve's armhole")
    place = np.median(top, axis=0)
    patch = tape[np.linalg.norm(tape - place, axis=1) < tuning.patch]
    normal = surface_normal(patch, frame.pose_camera_in_map[:3, 3])
    return GraspPoint(
        stamp=frame.stamp,
        confidence=min(1.0, len(top) / tuning.full_points),
        target=SLEEVE_OF[side],
        position_in_map=place,
        approach_in_map=-normal,
        closing_in_map=across(aside, -normal),
    )

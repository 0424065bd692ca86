"""The gown on top of an arm that lies: what is drawn up where a fold hides the armhole below it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import GraspPoint
from ..image.cloud import unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import GOWN_SURFACES
from .on_top import grasp_on_top


@dataclass(frozen=True, kw_only=True)
class ClothOnArmTuning(Quantities):
    """Numbers of where the gown is highest above an upper arm."""

    part: tuple[float, float] = quantity(
        (0.1, 0.6), "1", "of the upper arm, from the shoulder, above which cloth counts", "choice: beside the armhole"
    )
    half_width: float = quantity(
        0.10, "m", "aside of the arm's axis as seen from above, within which it does", "choice: an arm and a fold"
    )
    highest: float = quantity(0.2, "1", "share of that cloth, its highest, that is taken for the top", "choice: a fold")
    patch: float = quantity(0.05, "m", "around the place, over which its normal is taken", "choice: one cell of cloth")
    min_points: int = quantity(30, "1", "of cloth there", "choice: fewer are an edge of it")
    confidence: float = quantity(0.3, "1", "of a place that is no edge", "choice: below that of an armhole that shows")


DEFAULT = ClothOnArmTuning()


def cloth_on_arm(frame: Frame, side: Side, arm_in_map: np.ndarray, tuning: ClothOnArmTuning = DEFAULT) -> GraspPoint:
    """The gown where it is highest above the upper arm.

    Args:
        frame: of any camera.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        tuning: numbers of the search.

    Returns:
        The grasp in the map: into the cloth, and the fingers close along the arm.

    Raises:
        PerceptionFailure: too little of the gown is seen there.
    """
    shoulder, arm = arm_in_map[0], arm_in_map[1] - arm_in_map[0]
    along = unit(arm)
    aside = unit(np.cross(along, (0.0, 0.0, 1.0)))
    cloth = points_in_map(frame)[np.isin(gown_labels(frame), GOWN_SURFACES) & (frame.depth > 0)]
    off = cloth - shoulder
    share = off @ along / np.linalg.norm(arm)
    low, high = tuning.part
    above = (off - np.outer(off @ along, along))[:, 2] > 0.0
    near = cloth[(low < share) & (share < high) & (np.abs(off @ aside) < tuning.half_width) & above]
    if len(near) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"gown on the {side} arm")
    return grasp_on_top(
        frame,
        side,
        near,
        near[:, 2],
        cloth,
        aside,
        highest=tuning.highest,
        patch=tuning.patch,
        confidence=tuning.confidence,
    )

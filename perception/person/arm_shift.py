"""Whether an arm is still where it was a moment ago: skin that is gone, or that shows nearer, says no.

Two pictures are compared without a fit to either: points of the arm's skin in the first one are looked for where they
were, or where the hand that holds the arm has taken them.  What has come before them since, a hand or cloth, says
nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import Shift
from ..image.cloud import thinned
from ..image.projection import pixels_of, points_at, project
from ..image.surfaces import Surface, surfaces
from .arm_fit import nearest_on_chain, turned
from .person_facts import PERSON


@dataclass(frozen=True, kw_only=True)
class ArmShiftTuning(Quantities):
    """Numbers of the comparison."""

    from_share: float = quantity(
        0.5, "1", "of the upper arm, from which on its skin counts", "choice: next to the shoulder it hardly moves"
    )
    distance: float = quantity(
        0.04, "m", "of skin from the arm's surface at most", "choice: room for a posture that is a little off"
    )
    edge: int = quantity(3, "px", "of the window whose edge pixels mix two depths", "choice: one pixel to each side")
    max_points: int = quantity(600, "1", "of skin that are compared", "choice: more take longer and say the same")
    min_points: int = quantity(40, "1", "of them in free view", "choice: an arm beyond the trunk shows 300")
    margin: float = quantity(
        0.03, "m", "along the view by which skin has to have moved", "choice: ten times the noise of the depth"
    )
    reach: float = quantity(
        0.15, "m", "along the view within which nearer skin is that of this arm", "choice: beyond, the other arm's"
    )


DEFAULT = ArmShiftTuning()


def arm_shift(
    before: Frame,
    frame: Frame,
    arm_in_map: np.ndarray,
    grips_in_map: tuple[np.ndarray, np.ndarray] | None = None,
    tuning: ArmShiftTuning = DEFAULT,
) -> Shift:
    """How much of an arm's skin is elsewhere than where it was, or was taken.

    Of arms that their owners swung by 0.45 rad/s, 0.07 to 0.08 was after 0.07 s and 0.39 to 0.45 after 0.13 s (six
    simulated persons); of arms that nobody moved, or only the robot, at most 0.08 within 0.3 s of lifts and pulls.

    Args:
        before: a view of the arm.
        frame: a later view, from there or from elsewhere.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip at the time of `before` [m].
        grips_in_map: (3,) where a hand held it then, and (3,) where now; None for an arm that nobody holds [m].
        tuning: numbers.

    Raises:
        PerceptionFailure: too little of the arm shows in both of them.
    """
    skin = _skin_of(before, arm_in_map, tuning)
    if len(skin) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "the person's arm")
    if grips_in_map is not None:
        skin = turned(skin, arm_in_map[0], *grips_in_map)
    rows, columns, depth, inside = pixels_of(frame, skin)
    seen = frame.depth[rows, columns]
    measured = inside & (seen > 0.0)
    gone = measured & (seen > depth + tuning.margin)
    before_it = measured & (seen < depth - tuning.margin)
    is_skin = _skin_at(frame, rows, columns)
    nearer = before_it & is_skin & (seen > depth - tuning.reach)
    free = measured & ~(before_it & ~nearer)
    if free.sum() < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "the person's arm")
    share = float((gone | nearer).sum() / free.sum())
    return Shift(stamp=frame.stamp, confidence=float(free.mean()), share=share)


def _skin_of(frame: Frame, arm_in_map: np.ndarray, tuning: ArmShiftTuning) -> np.ndarray:
    """Points (n, 3) of an arm's skin [m]."""
    import cv2

    u, v, depth = project(frame, arm_in_map).T
    room = max(PERSON.arm_radii) + tuning.distance
    pad = frame.intrinsics[0] * room / max(float(depth.min()), room)
    window = tuple(slice(max(int(ends.min() - pad), 0), max(int(ends.max() + pad), 0) + 1) for ends in (v, u))
    if not frame.depth[window].size:
        return np.zeros((0, 3))  # out of view
    skin = (surfaces(frame.rgb[window]) == Surface.SKIN).astype(np.uint8)
    inner = cv2.erode(skin, np.ones((tuning.edge, tuning.edge), np.uint8)) > 0
    rows, columns = np.nonzero(inner & (frame.depth[window] > 0.0))
    points = points_at(frame, rows + window[0].start, columns + window[1].start)
    segment, share, distance, _ = nearest_on_chain(points, arm_in_map, np.array(PERSON.arm_radii))
    return thinned(
        points[(segment + share > tuning.from_share) & (np.abs(distance) < tuning.distance)], tuning.max_points
    )


def _skin_at(frame: Frame, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Whether pixels (n,) show skin."""
    first = rows.min(), columns.min()
    window = frame.rgb[first[0] : rows.max() + 1, first[1] : columns.max() + 1]
    return surfaces(window)[rows - first[0], columns - first[1]] == Surface.SKIN

"""From views all around the hanging gown to one pre-grasp manipulation.

The gown hangs from one hand, which turns it in steps of 30 degrees in front of the head camera.  In the frame of that
hand, a corner of the neckline keeps its place from view to view, but a place where the neckline only turns out of sight
moves.  So the candidates of all views vote in the hand's frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import PreGrasp, Primitive
from ..image.cloud import unit
from ..image.garment import gown_labels
from ..image.projection import points_in_map
from ..image.surfaces import Surface
from .collar import CornerCandidate, corner_candidates


@dataclass(frozen=True, kw_only=True)
class PreGraspTuning(Quantities):
    """Numbers of the choice of a corner and of the sweep before it is grasped."""

    sweep: float = quantity(0.05, "m", "of the two sweeping primitives, to the left and to the right", "paper: 5 cm")
    same_distance: float = quantity(
        0.07, "m", "in the hand's frame, within which candidates are the same corner", "choice: cloth swings that much"
    )
    min_distance: float = quantity(
        0.12, "m", "of a corner from the holding fingers", "choice: nothing can be grasped nearer to the other gripper"
    )
    full_score: float = quantity(
        1.5, "1", "of candidate and support together, that makes the corner certain", "choice: out of 2"
    )
    near_height: float = quantity(
        0.025, "m", "above and below the corner, of cloth in the way", "choice: a pad's width"
    )
    near_width: float = quantity(
        0.06, "m", "to either side of the corner, the same", "choice: the open gripper and a sweep"
    )
    near_distance: float = quantity(0.09, "m", "from the corner, the same", "choice: the open gripper's stroke")
    strip_half_width: float = quantity(
        0.02,
        "m",
        "beside the corner, where cloth is the strip itself",
        "choice: the strip goes on inwards from its end",
    )
    min_points: int = quantity(12, "1", "of cloth on one side that call for a sweep", "choice: fewer are noise")
    min_ratio: float = quantity(1.6, "1", "of cloth on one side to that on the other, the same", "choice: clearly more")


DEFAULT = PreGraspTuning()


def pregrasp_proposal(
    frames: Sequence[Frame],
    poses_hand_in_map: Sequence[np.ndarray],
    exclude: Sequence[np.ndarray] = (),
    distance: tuple[float, float] | None = None,
    tuning: PreGraspTuning = DEFAULT,
) -> PreGrasp:
    """Choose view, corner and primitive.

    Args:
        frames: views of the head camera, oldest first.
        poses_hand_in_map: (4, 4) of the holding hand at each frame, from the joint angles.
        exclude: points (3,) in the frame of the holding hand that were tried in vain [m].
        distance: least and greatest distance of the corner from the holding hand; without it, what can be grasped [m].
        tuning: numbers of the choice.

    Raises:
        PerceptionFailure: no view shows an end of the neckline.
    """
    nearest, farthest = (tuning.min_distance, np.inf) if distance is None else distance
    found: list[tuple[int, CornerCandidate, np.ndarray]] = []
    for view, (frame, pose) in enumerate(zip(frames, poses_hand_in_map, strict=True)):
        try:
            candidates = corner_candidates(frame)
        except PerceptionFailure:
            continue
        for c in candidates:
            in_hand = pose[:3, :3].T @ (c.position_in_map - pose[:3, 3])
            wanted = all(np.linalg.norm(in_hand - place) > tuning.same_distance for place in exclude)
            if wanted and nearest < np.linalg.norm(in_hand) < farthest:
                found.append((view, c, in_hand))
    if not found:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "corner of the neck binding in any view")
    places = np.array([p for _, _, p in found])
    support = []
    for view, _, place in found:
        best_of: dict[int, float] = {}  # other view -> score of its best candidate at the same place of the gown
        for (other, candidate, _), gap in zip(found, np.linalg.norm(places - place, axis=1), strict=True):
            if gap < tuning.same_distance and other != view:
                best_of[other] = max(best_of.get(other, 0.0), candidate.score)
        support.append(sum(best_of.values()) / max(1, len(frames) - 1))
    total = [c.score + s for (_, c, _), s in zip(found, support, strict=True)]
    best = int(np.argmax(total))
    view, corner, _ = found[best]
    frame = frames[view]
    approach = corner.position_in_map - frame.pose_camera_in_map[:3, 3]
    approach = unit(np.array((approach[0], approach[1], 0.0)))
    right = np.cross(approach, (0.0, 0.0, 1.0))
    primitive = choose_primitive(frame, corner, right, tuning)
    sweep = {"move_left": -tuning.sweep, "direct": 0.0, "move_right": tuning.sweep}[primitive] * right
    return PreGrasp(
        stamp=frame.stamp,
        confidence=float(min(1.0, total[best] / tuning.full_score)),
        primitive=primitive,
        view=view,
        position_in_map=corner.position_in_map - sweep / 2,
        approach_in_map=approach,
        sweep_in_map=sweep,
        corner_in_map=corner.position_in_map,
    )


def choose_primitive(
    frame: Frame, corner: CornerCandidate, right: np.ndarray, tuning: PreGraspTuning = DEFAULT
) -> Primitive:
    """Sweep away from the side on which other cloth lies within the open gripper, or not at all.

    Args:
        frame: the view.
        corner: where the fingers will close.
        right: (3,) horizontal unit vector in the map, to the right of the approach.
        tuning: numbers of the choice.
    """
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels != Surface.OTHER) & (frame.depth > 0))
    offset = points_in_map(frame)[rows, columns] - corner.position_in_map
    sideways = offset @ right
    inside = (np.abs(offset[:, 2]) < tuning.near_height) & (np.abs(sideways) < tuning.near_width)
    inside &= np.linalg.norm(offset, axis=1) < tuning.near_distance
    # the strip itself continues inwards from its end, so its own side counts only beyond its width
    on_left, on_right = sideways < -tuning.strip_half_width, sideways > tuning.strip_half_width
    counts = np.array(((inside & on_left).sum(), (inside & on_right).sum()), dtype=float)
    if counts.max() < tuning.min_points or counts.max() < tuning.min_ratio * counts.min():
        return "direct"
    return "move_right" if counts[0] > counts[1] else "move_left"

"""Stage B: from views all around the hanging gown to one pre-grasp manipulation.

The gown hangs from one hand, which turns it in steps of 30 degrees in front of the head camera.  A corner of the
neck binding keeps its place in the frame of that hand in every view; the places where the binding merely turns
out of sight wander.  So candidates of all views vote in the hand's frame.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...sim.world import Frame
from ..errors import PerceptionFailure, Problem
from ..estimates import PreGrasp, Primitive
from ..image.cloud import points_in_map, unit
from ..image.garment import gown_labels
from ..image.surfaces import Surface
from .collar import CornerCandidate, corner_candidates

SWEEP = 0.05  # of the two sweeping primitives [m], from the paper
_SAME = 0.07  # candidates closer than this in the hand's frame support each other [m]
_HELD = 0.12  # nearer than this to the holding fingers nothing can be grasped [m]


def pregrasp_proposal(
    frames: Sequence[Frame],
    poses_hand_in_map: Sequence[np.ndarray],
    exclude: Sequence[np.ndarray] = (),
    distance: tuple[float, float] = (_HELD, np.inf),
) -> PreGrasp:
    """Choose view, corner and primitive.

    Args:
        frames: views of the head camera, oldest first.
        poses_hand_in_map: (4, 4) of the holding hand at each frame, from the joint angles.
        exclude: points (3,) in the frame of the holding hand that were tried in vain [m].
        distance: least and greatest distance of the corner from the holding hand [m].

    Raises:
        PerceptionFailure: no view shows an end of the binding.
    """
    found: list[tuple[int, CornerCandidate, np.ndarray]] = []
    for view, (frame, pose) in enumerate(zip(frames, poses_hand_in_map, strict=True)):
        try:
            candidates = corner_candidates(frame)
        except PerceptionFailure:
            continue
        for c in candidates:
            in_hand = pose[:3, :3].T @ (c.position_in_map - pose[:3, 3])
            wanted = all(np.linalg.norm(in_hand - place) > _SAME for place in exclude)
            if wanted and distance[0] < np.linalg.norm(in_hand) < distance[1]:
                found.append((view, c, in_hand))
    if not found:
        raise PerceptionFailure(Problem.NOTHING_SEEN, "corner of the neck binding in any view")
    places = np.array([p for _, _, p in found])
    support = []
    for view, _, place in found:
        best_of: dict[int, float] = {}  # other view -> score of its best candidate at the same place of the gown
        for (other, candidate, _), gap in zip(found, np.linalg.norm(places - place, axis=1), strict=True):
            if gap < _SAME and other != view:
                best_of[other] = max(best_of.get(other, 0.0), candidate.score)
        support.append(sum(best_of.values()) / max(1, len(frames) - 1))
    total = [c.score + s for (_, c, _), s in zip(found, support, strict=True)]
    best = int(np.argmax(total))
    view, corner, _ = found[best]
    frame = frames[view]
    approach = corner.position_in_map - frame.pose_camera_in_map[:3, 3]
    approach = unit(np.array((approach[0], approach[1], 0.0)))
    right = np.cross(approach, (0.0, 0.0, 1.0))
    primitive = choose_primitive(frame, corner, right)
    sweep = {"move_left": -SWEEP, "direct": 0.0, "move_right": SWEEP}[primitive] * right
    return PreGrasp(
        stamp=frame.stamp,
        confidence=float(min(1.0, total[best] / 1.5)),
        primitive=primitive,
        view=view,
        position_in_map=corner.position_in_map - sweep / 2,
        approach_in_map=approach,
        sweep_in_map=sweep,
        corner_in_map=corner.position_in_map,
    )


def choose_primitive(frame: Frame, corner: CornerCandidate, right: np.ndarray) -> Primitive:
    """Sweep away from the side on which other cloth lies within the open gripper, or not at all.

    Args:
        frame: the view.
        corner: where the fingers will close.
        right: (3,) horizontal unit vector to the right of the approach.
    """
    labels = gown_labels(frame)
    rows, columns = np.nonzero((labels != Surface.OTHER) & (frame.depth > 0))
    offset = points_in_map(frame)[rows, columns] - corner.position_in_map
    sideways = offset @ right
    inside = (np.abs(offset[:, 2]) < 0.025) & (np.abs(sideways) < 0.06) & (np.linalg.norm(offset, axis=1) < 0.09)
    # the strip itself continues inwards from its end, so its own side counts only beyond its width
    left, away = inside & (sideways < -0.02), inside & (sideways > 0.02)
    counts = np.array((left.sum(), away.sum()), dtype=float)
    if counts.max() < 12 or counts.max() < 1.6 * counts.min():
        return "direct"
    return "move_right" if counts[0] > counts[1] else "move_left"

"""All estimators by name, with one way to call them: `function(frame, **details) -> Estimate`.

| name | details | estimate |
|---|---|---|
| garment_mask | | GarmentMask |
| gown_side | | GownSide |
| hang_point | | GraspPoint `near_hang` |
| collar_line | | CollarLine |
| collar_corner | side, exclude, below | GraspPoint `collar_corner_*` |
| pre_grasp | frames, poses_hand_in_map, exclude, distance | PreGrasp |
| layers | side, pose_hand_in_map, frames, poses_cloth_in_map, opening | LayerCount |
| gripped_cloth | pose_hand_in_map | Estimate: confidence that cloth is held |
| sleeve_opening | side, near_in_map | SleeveOpening |
| sleeve_strap | side, near_in_map | SleeveOpening |
| collar_near_shoulder | side, shoulder_in_map | GraspPoint `collar_*` |
| hook | | GraspPoint `near_hang`: where the gown hangs |
| hung_side | | GownSide |
| shown_corner | hook_in_map, side | GraspPoint `collar_corner_*`: the one that shows best |
| hung_corner | side, hook_in_map, other_length, near_in_map | GraspPoint `collar_corner_*` |
| head | | Head |
| chest_cover | shoulders_in_map | Cover |
| hand_cover | points_in_map | Cover |
| cuff_round | points_in_map | Cover: share of the way round an arm |
| held_armhole | side, near_in_map | SleeveOpening |
| sleeve_heading | side, near_in_map | SleeveHeading: from the armhole to the cuff |
| worn_sleeve | side, arm_in_map | WornSleeve: where it shows along the upper arm |
| arm | side, grip_in_map, fraction, afresh | ArmPosture |

`frames` are earlier views, oldest first; `frame` is the latest.  Every estimator raises PerceptionFailure instead of
guessing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..sim.world import SIDES, Frame, RoomMap, Side
from .errors import PerceptionFailure, Problem
from .estimates import ArmPosture, Cover, Estimate, GraspPoint, LayerCount, PreGrasp
from .gown.collar import collar_corner, collar_line, collar_near_shoulder
from .gown.hang_point import grasp_near_hang
from .gown.hung_corner import hook, hung_corner, shown_corner
from .gown.hung_side import hung_side
from .gown.layers import gripped_cloth, layers
from .gown.pregrasp import pregrasp_proposal
from .image.garment import garment_mask, gown_side
from .person.arm_tracker import ArmTracker
from .person.chest_cover import chest_cover
from .person.hand_cover import hand_cover
from .person.skin import head_seen
from .sleeve.cuff_round_arm import cuff_round
from .sleeve.held_armhole import held_armhole
from .sleeve.held_sleeve_heading import sleeve_heading
from .sleeve.lying_sleeve import sleeve_opening
from .sleeve.strap import sleeve_strap
from .sleeve.worn_sleeve import worn_sleeve

Estimator = Callable[..., Estimate]


def classical_estimators(room: RoomMap, seed: int) -> dict[str, Estimator]:
    """The estimators of this package for one run; the arms are tracked from call to call.

    Args:
        room: for the place of the bed.
        seed: of the random choices among equally good grasps.
    """
    rng = np.random.default_rng(seed)
    trackers = {side: ArmTracker(side, room.bed) for side in SIDES}

    def hang_point(frame: Frame) -> GraspPoint:
        return grasp_near_hang(frame, rng)

    def corner(frame: Frame, side: Side, **details: Any) -> GraspPoint:
        return collar_corner(frame, side, **details)

    def pre_grasp(
        frame: Frame, poses_hand_in_map: Sequence[np.ndarray], frames: Sequence[Frame] = (), **details: Any
    ) -> PreGrasp:
        return pregrasp_proposal([*frames, frame], poses_hand_in_map, **details)

    def count(
        frame: Frame, side: Side, pose_hand_in_map: np.ndarray, frames: Sequence[Frame] = (), **details: Any
    ) -> LayerCount:
        return layers([*frames, frame], side, pose_hand_in_map, **details)

    def head(frame: Frame) -> Estimate:
        return head_seen(frame, room.bed)

    def cover(frame: Frame, shoulders_in_map: np.ndarray) -> Cover:
        return chest_cover(frame, room.bed, shoulders_in_map)

    def arm(
        frame: Frame, side: Side, grip_in_map: np.ndarray | None = None, fraction: float = 1.0, afresh: bool = False
    ) -> ArmPosture:
        """Posture now; `grip_in_map` (3,) is where the robot holds the arm, `fraction` 0 shoulder to 3 fingertip.

        `afresh`: the arm does not show where it was, so look for it elsewhere.
        """
        tracker = trackers[side]
        if afresh:
            if not tracker.started or not tracker.look_afresh(frame):
                raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
            return tracker.estimate(frame.stamp)
        if grip_in_map is not None and tracker.started:  # first: it says where to look
            tracker.update_grip(frame.stamp, grip_in_map, fraction)
        tracker.update(frame)
        return tracker.estimate(frame.stamp)

    return {
        "garment_mask": garment_mask,
        "gown_side": gown_side,
        "hang_point": hang_point,
        "collar_line": collar_line,
        "collar_corner": corner,
        "pre_grasp": pre_grasp,
        "layers": count,
        "gripped_cloth": gripped_cloth,
        "sleeve_opening": sleeve_opening,
        "hook": hook,
        "shown_corner": shown_corner,
        "hung_corner": hung_corner,
        "hung_side": hung_side,
        "held_armhole": held_armhole,
        "sleeve_heading": sleeve_heading,
        "worn_sleeve": worn_sleeve,
        "hand_cover": hand_cover,
        "cuff_round": cuff_round,
        "sleeve_strap": sleeve_strap,
        "collar_near_shoulder": collar_near_shoulder,
        "head": head,
        "chest_cover": cover,
        "arm": arm,
    }

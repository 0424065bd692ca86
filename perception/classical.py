"""Senses by image processing: the gown by its colours, the person by skin and depth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..sim.quantity import Quantities
from ..sim.world import SIDES, Frame, RoomMap, Side
from .errors import PerceptionFailure, Problem
from .estimates import (
    ArmPosture,
    Cover,
    Estimate,
    GownSide,
    GraspPoint,
    Head,
    LayerCount,
    PreGrasp,
    SleeveHeading,
    SleeveOpening,
    WornSleeve,
)
from .gown.collar import collar_near_shoulder
from .gown.hang_point import grasp_near_hang
from .gown.hung_corner import hook, hung_corner, shown_corner
from .gown.hung_side import hung_side
from .gown.layers import gripped_cloth, layers
from .gown.pregrasp import pregrasp_proposal
from .image.garment import gown_side
from .person.arm_tracker import ArmTracker, ArmTrackerTuning
from .person.chest_cover import ChestCoverTuning, chest_cover
from .person.hand_cover import HandCoverTuning, hand_cover
from .person.head import HeadTuning, head_seen
from .person.skin import SkinTuning
from .senses import Senses
from .sleeve.cuff_round_arm import cuff_round
from .sleeve.held_armhole import held_armhole
from .sleeve.held_sleeve_heading import sleeve_heading
from .sleeve.lying_sleeve import sleeve_opening
from .sleeve.strap import sleeve_strap
from .sleeve.worn_sleeve import worn_sleeve


@dataclass(frozen=True, kw_only=True)
class ClassicalTuning(Quantities):
    """Numbers of the senses."""

    skin: SkinTuning = field(default_factory=SkinTuning)
    head: HeadTuning = field(default_factory=HeadTuning)
    arm: ArmTrackerTuning = field(default_factory=ArmTrackerTuning)
    chest_cover: ChestCoverTuning = field(default_factory=ChestCoverTuning)
    hand_cover: HandCoverTuning = field(default_factory=HandCoverTuning)


DEFAULT = ClassicalTuning()


class ClassicalSenses(Senses):
    """The senses of one run; both arms are tracked from call to call.

    Args:
        room: says where the bed is.
        seed: of the random choice among equally good grasps.
        tuning: numbers.
    """

    def __init__(self, room: RoomMap, seed: int, *, tuning: ClassicalTuning = DEFAULT) -> None:
        self._bed = room.bed
        self._tuning = tuning
        self._rng = np.random.default_rng(seed)
        self._trackers: dict[Side, ArmTracker] = {
            side: ArmTracker(side, room.bed, tuning=tuning.arm, head_tuning=tuning.head, skin_tuning=tuning.skin)
            for side in SIDES
        }

    def hang_point(self, frame: Frame) -> GraspPoint:
        """A random place at the paper's distance from the hanging point, on the neck binding where it shows."""
        return grasp_near_hang(frame, self._rng)

    def hook(self, frame: Frame) -> GraspPoint:
        """The highest part of the neck binding."""
        return hook(frame)

    def shown_corner(self, frame: Frame, *, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        """The lower end of a strip of neck binding; which one it is, its fabric beside it tells."""
        return shown_corner(frame, hook_in_map, side)

    def hung_corner(
        self,
        frame: Frame,
        *,
        side: Side,
        hook_in_map: np.ndarray,
        other_length: float | None = None,
        near_in_map: np.ndarray | None = None,
    ) -> GraspPoint:
        """The lower end of the strip of neck binding that fits what is known."""
        return hung_corner(frame, side, hook_in_map, other_length, near_in_map)

    def gown_side(self, frame: Frame) -> GownSide:
        """By the area of printed and of plain fabric."""
        return gown_side(frame)

    def hung_side(self, frame: Frame) -> GownSide:
        """By the area of printed and of plain fabric below the hook."""
        return hung_side(frame)

    def gripped_cloth(self, frame: Frame, *, pose_hand_in_map: np.ndarray) -> Estimate:
        """By the share of the disc around the fingertips in which points of the gown lie."""
        return gripped_cloth(frame, pose_hand_in_map)

    def pre_grasp(
        self,
        frames: Sequence[Frame],
        *,
        poses_hand_in_map: Sequence[np.ndarray],
        distance: tuple[float, float],
        exclude: Sequence[np.ndarray] = (),
    ) -> PreGrasp:
        """The end of the neck binding that several views agree on."""
        return pregrasp_proposal(frames, poses_hand_in_map, exclude, distance)

    def layers(
        self,
        frames: Sequence[Frame],
        *,
        side: Side,
        pose_hand_in_map: np.ndarray,
        poses_cloth_in_map: Sequence[np.ndarray],
        opening: float,
    ) -> LayerCount:
        """By the sheets of points in the volume that the fingers sweep."""
        return layers(frames, side, pose_hand_in_map, poses_cloth_in_map, opening)

    def sleeve_opening(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """By the armhole's binding, and the end of the neck binding beside it."""
        return sleeve_opening(frame, side, near_in_map)

    def sleeve_strap(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """Between the armhole's rim and the gown's edge, or past the end of the neck binding."""
        return sleeve_strap(frame, side, near_in_map)

    def held_armhole(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """By the armhole's binding around the grip."""
        return held_armhole(frame, side, near_in_map)

    def sleeve_heading(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
        """By the bindings of armhole and cuff around the grip."""
        return sleeve_heading(frame, side, near_in_map)

    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """By the bindings of armhole and cuff near the upper arm."""
        return worn_sleeve(frame, side, arm_in_map)

    def hand_cover(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """By the skin that shows along the axis of the hand."""
        return hand_cover(frame, points_in_map, self._tuning.hand_cover)

    def cuff_round(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """By the cuff's binding about the axis."""
        return cuff_round(frame, points_in_map)

    def chest_cover(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> Cover:
        """By the gown's colours at a grid of points on the front of the trunk."""
        return chest_cover(frame, self._bed, shoulders_in_map, self._tuning.chest_cover)

    def collar_near_shoulder(self, frame: Frame, *, side: Side, shoulder_in_map: np.ndarray) -> GraspPoint:
        """The end of the neck binding at the armhole that sits near the shoulder."""
        return collar_near_shoulder(frame, side, shoulder_in_map)

    def head(self, frame: Frame) -> Head:
        """The skin at the head end of the bed, as wide and as high as a head."""
        return head_seen(frame, self._bed, self._tuning.head, self._tuning.skin)

    def arm(
        self, frame: Frame, *, side: Side, grip_in_map: np.ndarray | None = None, arm_coordinate: float = 1.0
    ) -> ArmPosture:
        """A chain of capsules fitted to the skin, filtered over time."""
        tracker = self._trackers[side]
        if grip_in_map is not None and tracker.started:  # first: it says where to look
            tracker.update_grip(frame.stamp, grip_in_map, arm_coordinate)
        tracker.update(frame)
        return tracker.estimate(frame.stamp)

    def relocalised_arm(self, frame: Frame, *, side: Side) -> ArmPosture:
        """A new fit from many postures, believed where bare skin shows all along it."""
        tracker = self._trackers[side]
        if not tracker.started or not tracker.look_afresh(frame):
            raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
        return tracker.estimate(frame.stamp)

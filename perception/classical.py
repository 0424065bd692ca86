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
    ChestCover,
    ChestFront,
    Cover,
    Estimate,
    GownSide,
    GraspPoint,
    Head,
    LayerCount,
    PreGrasp,
    Shift,
    SleeveHeading,
    SleeveOpening,
    SleeveProfile,
    WornSleeve,
)
from .gown.collar import CollarTuning, collar_middle
from .gown.hang_point import HangPointTuning, grasp_near_hang
from .gown.hung_corner import HungCornerTuning, hook, hung_corner, shown_corner
from .gown.hung_side import HungSideTuning, hung_side
from .gown.layers import LayersTuning, gripped_cloth, layers
from .gown.overhang import OverhangTuning, overhang
from .gown.pregrasp import PreGraspTuning, pregrasp_proposal
from .image.garment import GarmentTuning, gown_side
from .person.arm_shift import ArmShiftTuning, arm_shift
from .person.arm_tracker import ArmTracker, ArmTrackerTuning
from .person.chest_cover import ChestCoverTuning, chest_cover
from .person.chest_front import ChestFrontTuning, chest_front
from .person.head import HeadTuning, head_seen
from .person.skin import SkinTuning
from .person.skin_cover import SkinCoverTuning, skin_cover
from .senses import Senses
from .sleeve.cuff_round_arm import CuffTuning, cuff_round
from .sleeve.held_armhole import HeldArmholeTuning, held_armhole
from .sleeve.held_sleeve_heading import SleeveHeadingTuning, sleeve_heading
from .sleeve.lying_sleeve import LyingSleeveTuning, sleeve_opening
from .sleeve.shoulder_seam import ShoulderSeamTuning, shoulder_seam
from .sleeve.sleeve_profile import SleeveProfileTuning, sleeve_profile
from .sleeve.strap import StrapTuning, sleeve_strap
from .sleeve.worn_sleeve import WornSleeveTuning, worn_sleeve


@dataclass(frozen=True, kw_only=True)
class ClassicalTuning(Quantities):
    """Numbers of the senses."""

    hang_point: HangPointTuning = field(default_factory=HangPointTuning)
    hung_corner: HungCornerTuning = field(default_factory=HungCornerTuning)
    gown_side: GarmentTuning = field(default_factory=GarmentTuning)
    hung_side: HungSideTuning = field(default_factory=HungSideTuning)
    layers: LayersTuning = field(default_factory=LayersTuning)
    pre_grasp: PreGraspTuning = field(default_factory=PreGraspTuning)
    sleeve_opening: LyingSleeveTuning = field(default_factory=LyingSleeveTuning)
    sleeve_strap: StrapTuning = field(default_factory=StrapTuning)
    held_armhole: HeldArmholeTuning = field(default_factory=HeldArmholeTuning)
    sleeve_heading: SleeveHeadingTuning = field(default_factory=SleeveHeadingTuning)
    worn_sleeve: WornSleeveTuning = field(default_factory=WornSleeveTuning)
    sleeve_profile: SleeveProfileTuning = field(default_factory=SleeveProfileTuning)
    cuff_round: CuffTuning = field(default_factory=CuffTuning)
    collar: CollarTuning = field(default_factory=CollarTuning)
    overhang: OverhangTuning = field(default_factory=OverhangTuning)
    skin: SkinTuning = field(default_factory=SkinTuning)
    head: HeadTuning = field(default_factory=HeadTuning)
    arm: ArmTrackerTuning = field(default_factory=ArmTrackerTuning)
    arm_shift: ArmShiftTuning = field(default_factory=ArmShiftTuning)
    chest_cover: ChestCoverTuning = field(default_factory=ChestCoverTuning)
    chest_front: ChestFrontTuning = field(default_factory=ChestFrontTuning)
    shoulder_seam: ShoulderSeamTuning = field(default_factory=ShoulderSeamTuning)
    skin_cover: SkinCoverTuning = field(default_factory=SkinCoverTuning)


DEFAULT = ClassicalTuning()


class ClassicalSenses(Senses):
    """The senses of one run; both arms are tracked from call to call.

    Args:
        room: says where the bed is.
        seed: of the random choice among equally good grasps, or a generator for it.
        tuning: numbers.
    """

    def __init__(self, room: RoomMap, seed: int | np.random.Generator, *, tuning: ClassicalTuning = DEFAULT) -> None:
        self._bed = room.bed
        self._tuning = tuning
        self._rng = np.random.default_rng(seed)
        self._trackers: dict[Side, ArmTracker] = {
            side: ArmTracker(side, room.bed, tuning=tuning.arm, head_tuning=tuning.head, skin_tuning=tuning.skin)
            for side in SIDES
        }

    def hang_point(self, frame: Frame) -> GraspPoint:
        """A random place at the paper's distance from the hanging point, on the neck binding where it shows."""
        return grasp_near_hang(frame, self._rng, self._tuning.hang_point)

    def hook(self, frame: Frame) -> GraspPoint:
        """The highest part of the neck binding."""
        return hook(frame, self._tuning.hung_corner)

    def shown_corner(self, frame: Frame, *, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        """The lower end of a strip of neck binding; which one it is, its fabric beside it tells."""
        return shown_corner(frame, hook_in_map, side, self._tuning.hung_corner)

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
        return hung_corner(frame, side, hook_in_map, other_length, near_in_map, self._tuning.hung_corner)

    def gown_side(self, frame: Frame) -> GownSide:
        """By the area of printed and of plain fabric."""
        return gown_side(frame, self._tuning.gown_side)

    def hung_side(self, frame: Frame) -> GownSide:
        """By the area of printed and of plain fabric below the hook."""
        return hung_side(frame, self._tuning.hung_side)

    def gripped_cloth(self, frame: Frame, *, pose_hand_in_map: np.ndarray) -> Estimate:
        """By the share of the disc around the fingertips in which points of the gown lie."""
        return gripped_cloth(frame, pose_hand_in_map, self._tuning.layers)

    def pre_grasp(
        self,
        frames: Sequence[Frame],
        *,
        poses_hand_in_map: Sequence[np.ndarray],
        distance: tuple[float, float],
        exclude: Sequence[np.ndarray] = (),
    ) -> PreGrasp:
        """The end of the neck binding that several views agree on."""
        return pregrasp_proposal(frames, poses_hand_in_map, exclude, distance, self._tuning.pre_grasp)

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
        return layers(frames, side, pose_hand_in_map, poses_cloth_in_map, opening, self._tuning.layers)

    def sleeve_opening(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """By the armhole's binding, and the end of the neck binding beside it."""
        return sleeve_opening(frame, side, near_in_map, self._tuning.sleeve_opening)

    def sleeve_strap(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """Between the armhole's rim and the gown's edge, or past the end of the neck binding."""
        return sleeve_strap(frame, side, near_in_map, self._tuning.sleeve_strap)

    def held_armhole(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """By the armhole's binding around the grip."""
        return held_armhole(frame, side, near_in_map, self._tuning.held_armhole)

    def sleeve_heading(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
        """By the bindings of armhole and cuff around the grip."""
        return sleeve_heading(frame, side, near_in_map, self._tuning.sleeve_heading)

    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """By the bindings of armhole and cuff near the upper arm."""
        return worn_sleeve(frame, side, arm_in_map, self._tuning.worn_sleeve)

    def sleeve_profile(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> SleeveProfile:
        """By the bindings of armhole and cuff near the upper arm."""
        return sleeve_profile(frame, side, arm_in_map, self._tuning.sleeve_profile)

    def sleeve_on_forearm(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """As on an upper arm, by the bindings near the forearm."""
        return worn_sleeve(frame, side, arm_in_map[1:], self._tuning.worn_sleeve)

    def shoulder_seam(self, frame: Frame, *, side: Side, shoulders_in_map: np.ndarray) -> GraspPoint:
        """By the gown that is nearest to the person's head beside the shoulder."""
        return shoulder_seam(frame, side, shoulders_in_map, self._tuning.shoulder_seam)

    def skin_cover(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """By the skin that shows along the axis of the hand."""
        return skin_cover(frame, points_in_map, self._tuning.skin_cover)

    def cuff_round(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """By the cuff's binding about the axis."""
        return cuff_round(frame, points_in_map, self._tuning.cuff_round)

    def chest_cover(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestCover:
        """By the gown's colours at a grid of points on the front of the trunk."""
        return chest_cover(frame, self._bed, shoulders_in_map, self._tuning.chest_cover)

    def chest_front(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestFront:
        """By the depth of cells on the front of the chest."""
        return chest_front(frame, self._bed, shoulders_in_map, self._tuning.chest_front)

    def overhang(self, frame: Frame, *, side: Side) -> Cover:
        """By the area of the gown that each pixel shows."""
        return overhang(frame, self._bed, side, self._tuning.overhang)

    def collar_middle(
        self,
        frame: Frame,
        *,
        near_in_map: np.ndarray,
        away: tuple[float, float] = (0.0, 0.0),
        beside: Sequence[Frame] = (),
    ) -> GraspPoint:
        """Half the neck binding's length from its ends."""
        return collar_middle(frame, near_in_map, away, self._tuning.collar, beside)

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

    def relocalised_arm(self, frame: Frame, *, side: Side, moved: bool = False) -> ArmPosture:
        """A new fit from many postures, believed where bare skin shows all along it."""
        tracker = self._trackers[side]
        if not tracker.started or not tracker.look_afresh(frame, moved=moved):
            raise PerceptionFailure(Problem.ARM_LOST, f"{side} arm")
        return tracker.estimate(frame.stamp)

    def arm_shift(
        self,
        frame: Frame,
        *,
        before: Frame,
        arm_in_map: np.ndarray,
        grips_in_map: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> Shift:
        """By the skin that shows behind or before where it has to be."""
        return arm_shift(before, frame, arm_in_map, grips_in_map, self._tuning.arm_shift)

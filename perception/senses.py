"""What skills may ask about the images: one abstract class with one typed method for each estimate."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np

from ..sim.errors import CaretreeError
from ..sim.world import Frame, Side
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

_Senses = TypeVar("_Senses", bound="Senses")


class Senses(ABC):
    """Everything that is estimated from images, whoever estimates it: image processing, a script, a network.

    Every method takes a frame, raises PerceptionFailure instead of guessing, and returns an estimate that bears the
    stamp of the frame.  Points are in the map frame [m].  Sides of sleeves and arms are the person's own.

    Raises:
        CaretreeError: on construction, a class lacks some of the methods; says which.
    """

    def __new__(cls: type[_Senses], *_args: Any, **_options: Any) -> _Senses:
        """Refuse a class that is not whole in one sentence."""
        if lacking := sorted(cls.__abstractmethods__):
            raise CaretreeError(f"the senses {cls.__name__} lack {', '.join(lacking)}")
        return object.__new__(cls)

    # -- the gown on its hook ----------------------------------------------------------------------------

    @abstractmethod
    def hang_point(self, frame: Frame) -> GraspPoint:
        """A place to grasp a little beside the point from which the gown hangs.

        Args:
            frame: of a camera that sees the hung gown.

        Returns:
            Target `near_hang`, with a horizontal approach.

        Raises:
            PerceptionFailure: no gown, or none of it with depth at that distance.
        """

    @abstractmethod
    def hook(self, frame: Frame) -> GraspPoint:
        """Where the gown hangs: the top of its neckline.

        Args:
            frame: of a camera that sees the hung gown.

        Returns:
            Target `near_hang`, with a horizontal approach from the camera's side.

        Raises:
            PerceptionFailure: no neckline is seen.
        """

    @abstractmethod
    def shown_corner(self, frame: Frame, *, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        """The corner of a hung gown's neckline that shows best; the target tells which one it is.

        Args:
            frame: of a camera that sees the gown's outside.
            hook_in_map: (3,) where the gown hangs [m].
            side: the wearer's, if only that one is wanted.

        Returns:
            Target `collar_corner_left` or `collar_corner_right`.  Its confidence is below 0.5 where other cloth hangs
            so near that the fingers might take it too.

        Raises:
            PerceptionFailure: neither shows, or not the one that is wanted.
        """

    @abstractmethod
    def hung_corner(
        self,
        frame: Frame,
        *,
        side: Side,
        hook_in_map: np.ndarray,
        other_length: float | None = None,
        near_in_map: np.ndarray | None = None,
    ) -> GraspPoint:
        """One corner of a hung gown's neckline: one that was seen just now, or the second one.

        Args:
            frame: of a camera that sees the gown's outside.
            side: the wearer's.
            hook_in_map: (3,) where the gown hangs [m].
            other_length: from the hook to the other corner, if that is held aside already [m].
            near_in_map: (3,) where the corner was just now [m].

        Returns:
            Target `collar_corner_left` or `_right`; below a confidence of 0.5 inferred, or with other cloth beside it.

        Raises:
            PerceptionFailure: the corner is not seen.
        """

    @abstractmethod
    def gown_side(self, frame: Frame) -> GownSide:
        """Which side of the gown faces the camera, by all of it that is seen.

        Args:
            frame: of a camera that sees the gown.

        Raises:
            PerceptionFailure: no fabric is seen.
        """

    @abstractmethod
    def hung_side(self, frame: Frame) -> GownSide:
        """Which side of a hung gown faces the camera, by what hangs just below its hook.

        Args:
            frame: of a camera that sees the hung gown.

        Raises:
            PerceptionFailure: no neckline, or no fabric, is seen.
        """

    # -- the gown in the hands ---------------------------------------------------------------------------

    @abstractmethod
    def gripped_cloth(self, frame: Frame, *, pose_hand_in_map: np.ndarray) -> Estimate:
        """Whether the fingers of a hand hold cloth: confidence 0 (nothing there) to 1.

        Args:
            frame: any view of the fingertips.
            pose_hand_in_map: (4, 4) of the hand, from the joint angles.

        Raises:
            PerceptionFailure: the fingertips are outside the image, or there is no depth at all.
        """

    @abstractmethod
    def pre_grasp(
        self,
        frames: Sequence[Frame],
        *,
        poses_hand_in_map: Sequence[np.ndarray],
        distance: tuple[float, float],
        exclude: Sequence[np.ndarray] = (),
    ) -> PreGrasp:
        """Which end of the neckline to take next while the other hand holds the gown, and how to isolate it.

        Args:
            frames: views of the head camera, oldest first.
            poses_hand_in_map: (4, 4) of the holding hand at each frame, from the joint angles.
            distance: least and greatest distance of the end from the holding hand [m].
            exclude: (3,) points in the frame of the holding hand that were tried in vain [m].

        Raises:
            PerceptionFailure: no view shows an end of the neckline.
        """

    @abstractmethod
    def layers(
        self,
        frames: Sequence[Frame],
        *,
        side: Side,
        pose_hand_in_map: np.ndarray,
        poses_cloth_in_map: Sequence[np.ndarray],
        opening: float,
    ) -> LayerCount:
        """How many layers of cloth the open fingers would take if they closed.

        Args:
            frames: views of the cloth, oldest first.
            side: of the hand.
            pose_hand_in_map: (4, 4) of the hand that would close.
            poses_cloth_in_map: (4, 4) of what holds the cloth at each frame: the cloth moves with it.
            opening: between the fingers [m].

        Raises:
            PerceptionFailure: no cloth is seen there.
        """

    # -- sleeves -----------------------------------------------------------------------------------------

    @abstractmethod
    def sleeve_opening(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """The armhole of a lying sleeve, with the middle of its rim on the shoulder's side as the place to grasp.

        Args:
            frame: a view of the gown, lying on the person or hanging from both hands.
            side: of the sleeve.
            near_in_map: (3,) roughly where it is [m].

        Raises:
            PerceptionFailure: no armhole is seen near that point.
        """

    @abstractmethod
    def sleeve_strap(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """The strap between armhole and neckline of a lying sleeve, and how it lies, as the place to grasp.

        Args:
            frame: a view from close by, such as a hand camera's.
            side: of the sleeve.
            near_in_map: (3,) roughly where its armhole is [m].

        Returns:
            Position: its middle.  Closing: across it; approach x closing points along it, outwards on the left side.

        Raises:
            PerceptionFailure: no armhole near the place, or the strap is hidden.
        """

    @abstractmethod
    def held_armhole(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """What shows of the armhole of a sleeve that is held by its strap.

        Args:
            frame: of any camera.
            side: of the sleeve.
            near_in_map: (3,) fingertips that hold the strap [m].

        Returns:
            Points of its binding, and as centre the middle of their extent; the position is that of the grip.

        Raises:
            PerceptionFailure: too little of it is seen.
        """

    @abstractmethod
    def sleeve_heading(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
        """Which way a sleeve that is held by its strap points.

        Args:
            frame: of any camera.
            side: of the sleeve.
            near_in_map: (3,) fingertips that hold the strap [m].

        Raises:
            PerceptionFailure: too little of its armhole or of its cuff is seen.
        """

    @abstractmethod
    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """Where along the upper arm a sleeve has come to sit, and how far round the arm its cuff shows.

        Args:
            frame: of any camera.
            side: of the person.
            arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].

        Raises:
            PerceptionFailure: too little of its armhole or of its cuff is seen.
        """

    @abstractmethod
    def sleeve_profile(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> SleeveProfile:
        """Where its bindings show round the arm; several pictures tell how it sits.  Else as `worn_sleeve`."""

    @abstractmethod
    def sleeve_on_forearm(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """Where one shows that is over the hand, not yet up the arm: 0 elbow, 1 wrist.  Else as `worn_sleeve`."""

    # -- the gown on the person --------------------------------------------------------------------------

    @abstractmethod
    def shoulder_seam(self, frame: Frame, *, side: Side, shoulders_in_map: np.ndarray) -> GraspPoint:
        """The outer end of the seam over a shoulder of a worn gown, where its sleeve is drawn up.

        Args:
            frame: a view from the head of the bed.
            side: of the person.
            shoulders_in_map: (2, 3) left and right [m].

        Returns:
            Target `sleeve_left` or `sleeve_right`.

        Raises:
            PerceptionFailure: too little of the gown shows there.
        """

    @abstractmethod
    def skin_cover(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """How much of the person's hand, or of an arm, is covered.

        Args:
            frame: a view from close by; what stands between counts as a cover.
            points_in_map: (n, 3) on its axis [m].

        Raises:
            PerceptionFailure: too few of the points are in view.
        """

    @abstractmethod
    def cuff_round(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """How far round an arm a cuff shows: share of the directions off the arm's axis.

        Args:
            frame: of any camera.
            points_in_map: (m, 3) chain along the axis of the arm, and beyond it as far as a cuff may be [m].

        Raises:
            PerceptionFailure: too little of a cuff shows near it.
        """

    @abstractmethod
    def chest_cover(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestCover:
        """How much of the front of the trunk lies under the gown.

        Args:
            frame: a view of the person.
            shoulders_in_map: (3,) middle between the shoulders [m].

        Raises:
            PerceptionFailure: no gown in the image, or too little of the trunk in view.
        """

    @abstractmethod
    def chest_front(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestFront:
        """How high the front of the chest lies, with what covers it.

        Args:
            frame: a view of the person.
            shoulders_in_map: (3,) middle between the shoulders [m].

        Raises:
            PerceptionFailure: too little of the chest in view.
        """

    @abstractmethod
    def overhang(self, frame: Frame, *, side: Side) -> Cover:
        """How much of the gown lies or hangs beyond the edge of the bed on a side of the person.

        Args:
            frame: of any camera.
            side: of the person.

        Returns:
            The share of what shows of it.

        Raises:
            PerceptionFailure: too little of the gown is seen.
        """

    @abstractmethod
    def collar_middle(
        self,
        frame: Frame,
        *,
        near_in_map: np.ndarray,
        away: tuple[float, float] = (0.0, 0.0),
        beside: Sequence[Frame] = (),
    ) -> GraspPoint:
        """The middle of a worn gown's neckline.

        Args:
            frame: a view from above the person.
            near_in_map: (3,) middle between the shoulders [m].
            away: from the middle to where the cloth is to be grasped, along x and y in the map [m].
            beside: more views of the same cloth, which show what folds and shoulders hide from `frame`.

        Returns:
            Target `collar_middle`; its confidence is the share of the neckline that shows.

        Raises:
            PerceptionFailure: no neckline is seen on the person.
        """

    # -- the person --------------------------------------------------------------------------------------

    @abstractmethod
    def head(self, frame: Frame) -> Head:
        """The person's head.

        Args:
            frame: a view of the person.

        Raises:
            PerceptionFailure: no head is seen.
        """

    @abstractmethod
    def arm(
        self, frame: Frame, *, side: Side, grip_in_map: np.ndarray | None = None, arm_coordinate: float = 1.0
    ) -> ArmPosture:
        """One arm of the person now, tracked from call to call.

        Args:
            frame: a view of the person.
            side: of the person.
            grip_in_map: (3,) where the robot holds the arm, if it does [m].
            arm_coordinate: of the grip along the arm: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.

        Raises:
            PerceptionFailure: it was never found, or has been lost for too long.
        """

    @abstractmethod
    def relocalised_arm(self, frame: Frame, *, side: Side, moved: bool = False) -> ArmPosture:
        """One arm that no longer shows where it was, looked for all over the image.

        Args:
            frame: a view of the person.
            side: of the person.
            moved: it is known to have moved; else it is not looked for while skin shows where it was.

        Raises:
            PerceptionFailure: it was never seen, or shows nowhere.
        """

    @abstractmethod
    def arm_shift(
        self,
        frame: Frame,
        *,
        before: Frame,
        arm_in_map: np.ndarray,
        grips_in_map: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> Shift:
        """How much of an arm is elsewhere than where it was a moment ago, or than where the robot has taken it.

        Args:
            frame: a view of the person.
            before: an earlier one.
            arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip at that time [m].
            grips_in_map: (3,) where a hand held it then, and (3,) where now; None if nobody holds it [m].

        Raises:
            PerceptionFailure: too little of the arm shows in both.
        """

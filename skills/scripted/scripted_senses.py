"""Senses without images: a gown before the robot, a person on the bed, always seen at the same places."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from ...perception.estimates import (
    CORNER_OF,
    SLEEVE_OF,
    ArmPosture,
    ChestCover,
    ChestFront,
    Cover,
    Estimate,
    GownSide,
    GraspPoint,
    GraspTarget,
    Head,
    LayerCount,
    PreGrasp,
    Shift,
    SleeveHeading,
    SleeveOpening,
    SleeveProfile,
    WornSleeve,
)
from ...perception.person.person_facts import PERSON
from ...perception.senses import Senses
from ...sim.mechanics.planar import planar_pose
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, Frame, Observation, Side
from ..geometry.stances import HEADWARD, outwards
from .scripted_person import laid_strap, lying_arm, lying_posture

_CHEST = 0.4  # from the collar, within which cloth lies on the chest [m]
_FACE = 0.1  # headward of the shoulders, from where a person has a face [m]

_Senses = TypeVar("_Senses", bound="ScriptedSenses")


@dataclass(frozen=True, kw_only=True)
class ScriptedGown(Quantities):
    """Where a hung gown is always seen, in the frame of the base."""

    distance: float = quantity(0.70, "m", "from the middle of the base ahead to the gown", "choice: within reach")
    height: float = quantity(1.20, "m", "of the hook above the floor", "choice: within reach of both arms")
    corner_offset: float = quantity(
        0.18, "m", "from the hook sideways to a corner of the neckline", "choice: both strips hang almost straight"
    )
    corner_drop: float = quantity(
        0.37, "m", "from the hook down to a corner of the neckline", "choice: half of an adult gown's neckline, hung"
    )


GOWN_SEEN = ScriptedGown()


class Proprioception(Protocol):
    """What knows where the robot is: a world, or the guard around it."""

    def observe(self) -> Observation:
        """Latest proprioception."""
        ...


@runtime_checkable
class _HasPerson(Protocol):
    """A world whose made up person may move."""

    @property
    def person_offset(self) -> np.ndarray: ...


class ScriptedSenses(Senses):
    """Everything shows, everything is well: for worlds without images, examples and tests.

    The hung gown is always before the robot; the person, and the gown on the person, lie as on the simulated bed.
    Subclass it to change single answers.

    Args:
        world: says where the robot is.
    """

    def __init__(self, world: Proprioception) -> None:
        self._world = world
        self._moved_before = self._moved()
        self._collar = 0.04  # across the bed [m]

    def on(self: _Senses, world: Proprioception) -> _Senses:
        """The same senses for another robot, such as one behind a ROS master."""
        other = copy(self)
        other._world = world
        return other

    def hang_point(self, frame: Frame) -> GraspPoint:
        """Straight ahead."""
        return self._point(frame, "near_hang", 0.0)

    def hook(self, frame: Frame) -> GraspPoint:
        """Straight ahead."""
        return self._point(frame, "near_hang", 0.0)

    def shown_corner(self, frame: Frame, *, hook_in_map: np.ndarray, side: Side | None = None) -> GraspPoint:
        """The one that is wanted, or the left one."""
        return self._corner(frame, side or "left")

    def hung_corner(
        self,
        frame: Frame,
        *,
        side: Side,
        hook_in_map: np.ndarray,
        other_length: float | None = None,
        near_in_map: np.ndarray | None = None,
    ) -> GraspPoint:
        """Below the hook and aside."""
        return self._corner(frame, side)

    def gown_side(self, frame: Frame) -> GownSide:
        """The outside."""
        return GownSide(stamp=frame.stamp, confidence=0.9, outside=True)

    def hung_side(self, frame: Frame) -> GownSide:
        """The outside."""
        return GownSide(stamp=frame.stamp, confidence=0.9, outside=True)

    def gripped_cloth(self, frame: Frame, *, pose_hand_in_map: np.ndarray) -> Estimate:
        """Every hand holds cloth."""
        return Estimate(stamp=frame.stamp, confidence=0.9)

    def pre_grasp(
        self,
        frames: Sequence[Frame],
        *,
        poses_hand_in_map: Sequence[np.ndarray],
        distance: tuple[float, float],
        exclude: Sequence[np.ndarray] = (),
    ) -> PreGrasp:
        """The same corner from everywhere, with nothing before it."""
        corner = self._point(frames[-1], "near_hang", 0.1)
        return PreGrasp(
            stamp=corner.stamp,
            confidence=0.9,
            view=0,
            primitive="direct",
            corner_in_map=corner.position_in_map,
            position_in_map=corner.position_in_map,
            approach_in_map=corner.approach_in_map,
            sweep_in_map=np.zeros(3),
        )

    def layers(
        self,
        frames: Sequence[Frame],
        *,
        side: Side,
        pose_hand_in_map: np.ndarray,
        poses_cloth_in_map: Sequence[np.ndarray],
        opening: float,
    ) -> LayerCount:
        """One."""
        return LayerCount(stamp=frames[-1].stamp, confidence=0.9, side=side, layers=1)

    def sleeve_opening(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """Where the gown lies on the bed."""
        return laid_strap(side, frame.stamp)

    def sleeve_strap(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """Where the gown lies on the bed."""
        return laid_strap(side, frame.stamp)

    def held_armhole(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        """Where the gown lies on the bed."""
        return laid_strap(side, frame.stamp)

    def sleeve_heading(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveHeading:
        """Along the hand at rest, and up: laid, it stands on the gown; held, it opens towards the hand."""
        _, _, wrist, fingertip = lying_arm(side)
        away = fingertip - wrist + (0.0, 0.0, 0.1)
        return SleeveHeading(stamp=frame.stamp, confidence=0.9, side=side, cuff_from_armhole_in_map=away)

    def worn_sleeve(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """At the shoulder, and round the arm."""
        return WornSleeve(
            stamp=frame.stamp, confidence=0.9, side=side, armhole_at=0.1, cuff_at=0.6, reach=0.9, round_arm=0.8
        )

    def sleeve_profile(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> SleeveProfile:
        """At the shoulder, all the way round."""
        armhole_at, cuff_at = np.full((2, 24), ((0.1,), (0.6,)))
        return SleeveProfile(stamp=frame.stamp, confidence=0.9, side=side, armhole_at=armhole_at, cuff_at=cuff_at)

    def sleeve_on_forearm(self, frame: Frame, *, side: Side, arm_in_map: np.ndarray) -> WornSleeve:
        """Beyond the hand: one that is over it is drawn up at once."""
        seen = ScriptedSenses.worn_sleeve(self, frame, side=side, arm_in_map=arm_in_map)
        return replace(seen, armhole_at=2.0, cuff_at=2.5, reach=0.0, round_arm=0.2)

    def shoulder_seam(self, frame: Frame, *, side: Side, shoulders_in_map: np.ndarray) -> GraspPoint:
        """Beside and headward of the shoulder."""
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.9,
            target=SLEEVE_OF[side],
            position_in_map=shoulders_in_map[SIDES.index(side)] + 0.15 * outwards(side) + 0.10 * HEADWARD,
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    def skin_cover(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """All of an arm; nothing of the face."""
        face = bool((points_in_map @ HEADWARD > PERSON.shoulders_headward + _FACE).all())
        return Cover(stamp=frame.stamp, confidence=0.9, share=0.0 if face else 1.0)

    def cuff_round(self, frame: Frame, *, points_in_map: np.ndarray) -> Cover:
        """All the way round."""
        return Cover(stamp=frame.stamp, confidence=0.9, share=1.0)

    def chest_cover(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestCover:
        """All of it."""
        return ChestCover(stamp=frame.stamp, confidence=0.9, share=1.0, outside=1.0)

    def chest_front(self, frame: Frame, *, shoulders_in_map: np.ndarray) -> ChestFront:
        """An adult's, and flat."""
        height = PERSON.front_height
        return ChestFront(stamp=frame.stamp, confidence=0.9, height=height, breastbone=height)

    def overhang(self, frame: Frame, *, side: Side) -> Cover:
        """A quarter of it."""
        return Cover(stamp=frame.stamp, confidence=0.9, share=0.25)

    def collar_middle(
        self,
        frame: Frame,
        *,
        near_in_map: np.ndarray,
        away: tuple[float, float] = (0.0, 0.0),
        beside: Sequence[Frame] = (),
    ) -> GraspPoint:
        """A little aside until it is asked where to grasp it on the chest, and then in the person's middle."""
        place = np.array((self._collar + away[0], -0.5 + away[1], 0.83))
        if 0.0 < np.hypot(*away) < _CHEST:
            self._collar = self._moved()[0]
        return GraspPoint(
            stamp=frame.stamp,
            confidence=1.0,  # all of it shows
            target="collar_middle",
            position_in_map=place,
            approach_in_map=np.array((0.0, 0.0, -1.0)),
            closing_in_map=np.array((0.0, 1.0, 0.0)),
        )

    def head(self, frame: Frame) -> Head:
        """On the midline of the bed."""
        return Head(stamp=frame.stamp, confidence=0.9, crown_in_map=np.array((0.0, -0.86, 0.88)), middle=0.0)

    def arm(
        self, frame: Frame, *, side: Side, grip_in_map: np.ndarray | None = None, arm_coordinate: float = 1.0
    ) -> ArmPosture:
        """At rest, wherever the person has moved to."""
        posture = lying_posture(side, frame.stamp)
        return replace(posture, points_in_map=posture.points_in_map + self._moved())

    def relocalised_arm(self, frame: Frame, *, side: Side, moved: bool = False) -> ArmPosture:
        """At rest."""
        return self.arm(frame, side=side)

    def arm_shift(
        self,
        frame: Frame,
        *,
        before: Frame,
        arm_in_map: np.ndarray,
        grips_in_map: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> Shift:
        """All of it when the person is elsewhere than at the last call."""
        before_that, self._moved_before = self._moved_before, self._moved()
        return Shift(stamp=frame.stamp, confidence=0.9, share=float(np.any(before_that != self._moved_before)))

    def _moved(self) -> np.ndarray:
        """How far (3,) the person has moved, in worlds where they do [m]."""
        return self._world.person_offset if isinstance(self._world, _HasPerson) else np.zeros(3)

    def _corner(self, frame: Frame, side: Side) -> GraspPoint:
        """Seen from outside, the wearer's right is on the robot's left."""
        aside = GOWN_SEEN.corner_offset
        return self._point(frame, CORNER_OF[side], aside if side == "right" else -aside, GOWN_SEEN.corner_drop)

    def _point(self, frame: Frame, target: GraspTarget, lateral: float, below: float = 0.0) -> GraspPoint:
        gown = np.array((GOWN_SEEN.distance, 0.0, GOWN_SEEN.height))
        base = planar_pose(self._world.observe().pose_base_in_map)
        place = base @ np.append(gown + (0.0, lateral, -below), 1.0)
        return GraspPoint(
            stamp=frame.stamp,
            confidence=0.9,
            target=target,
            position_in_map=place[:3],
            approach_in_map=base[:3, 0],
            closing_in_map=base[:3, 1],
        )

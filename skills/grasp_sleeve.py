"""Take hold of a sleeve by the strap of its armhole."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import careful, watch_arm
from .belief.refused_stands import refused_stands
from .belief.sleeve_search import SLEEVE_SEARCH, look_for_sleeve, seen_well, strap_views
from .belief.strap_grasp import way_in
from .belief.strap_turn import strap_turns
from .control.compliant_hold import while_holding
from .control.fingers import open_gripper
from .control.hands import hand_now, move_hands
from .control.pinch import pinch_or_back_off
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import ArmPath
from .geometry.hold import Hold
from .geometry.strap_grip import StrapGrip, strap_grip
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class GraspSleeveTuning(Quantities):
    """Numbers of looking closely at a strap and of taking it."""

    view_speed: float = quantity(0.5, "m/s", "of the hand to where it looks, away from the person", "choice: quick")
    centring_tolerance: float = quantity(
        0.05,
        "m",
        "between the strap and the middle of the picture, beyond which it is looked at again",
        "choice: a picture measures best in its middle",
    )
    approach_speed: float = quantity(
        0.3, "m/s", "of the hand to before the strap, away from the person", "choice: slower among cloth"
    )
    opening: float = quantity(
        0.06, "m", "between the fingers around the strap", "choice: 5 mm more than the strap's width"
    )
    reach_in_speed: float = quantity(
        0.12, "m/s", "of the hand in around the strap", "choice: does not push the cloth away"
    )


class GraspSleeve(Skill):
    """Finds the armhole with the head camera, looks at its strap with the hand's camera, and pinches the strap.

    It fails where the sleeve or the arm is not seen, where the strap is out of reach, where the person moves, and where
    the fingers close on nothing; such a miss ends with the hand open and drawn back.
    """

    side = Input(Side, doc="arm of the person that the sleeve belongs to")
    hand = Input(Side, doc="hand that grasps")
    hold = Input(Hold, default=None, doc="the hand that holds the arm meanwhile, or None")
    worn = Input(
        bool,
        default=False,
        doc="whether the sleeve is over the person's hand already, so that it is pulled on from where it is",
    )
    grip = Output(StrapGrip, doc="how the strap lies in the fingers")
    tuning = Input(GraspSleeveTuning, default=GraspSleeveTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.ARM_SLIPPED,
        Reason.PERSON_MOVED,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Grasp as long as the person does not move, easing the hold of the arm on every tick."""
        yield from while_person_rests(self, while_holding(self, self.hold, self._grasp()))

    def _grasp(self) -> Iterator[None]:
        """Look, reach in, pinch."""
        self.note(f"looks for the {self.side} sleeve")
        try:
            strap = yield from self._look()
            pose = yield from self._reach_in(strap)
        except (MotionError, PerceptionFailure):  # from here it was so four to six times in turn (190, 191, 192)
            self._refuse_stand()
            raise
        try:
            yield from pinch_or_back_off(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:  # four times in turn, alike (117)
                self._refuse_stand()
            raise
        strap_turns(self)[self.hand] = 0.0
        self.grip = strap_grip(self.side, self.hand, strap, pose)

    def _reach_in(self, strap: SleeveOpening) -> Generator[None, None, np.ndarray]:
        """Bring the open fingers to either side of the strap; returns the pose (4, 4) of the hand there."""
        tuning = self.tuning
        self.note(f"takes the {self.side} sleeve")
        path = ArmPath.of(watch_arm(self, self.side, hold=self.hold))
        way = way_in(self, self.side, self.hand, strap, path, worn=self.worn)
        yield from move_hands(self, {self.hand: way.before}, speed=careful(self, tuning.approach_speed), way="either")
        yield from open_gripper(self, self.hand, tuning.opening)
        seen_well(self).pop(self.side, None)
        yield from move_hands(self, {self.hand: way.inside}, speed=tuning.reach_in_speed, way="either")
        return hand_now(self, self.hand)

    def _refuse_stand(self) -> None:
        """The next try is from elsewhere, or the sleeve is laid elsewhere first; one on the arm is tried as it lies."""
        if not self.worn:
            refused_stands(self, self.side).append(self.world.observe().pose_base_in_map)

    def _look(self) -> Generator[None, None, SleeveOpening]:
        """From afar, then closely; once more where it turns out not to lie where it was seen well before."""
        far = yield from look_for_sleeve(self, self.side, self.hand, hold=self.hold, worn=self.worn)
        try:
            return (yield from self._look_closely(far))
        except (PerceptionFailure, MotionError):
            if seen_well(self).pop(self.side, None) is None:
                raise
        far = yield from look_for_sleeve(self, self.side, self.hand, hold=self.hold, worn=self.worn)
        return (yield from self._look_closely(far))

    def _look_closely(self, far: SleeveOpening) -> Generator[None, None, SleeveOpening]:
        """Bring the hand's camera in front of the strap; returns the strap as it is seen from there.

        A strap that is not where it was aimed at is looked at again, in the middle of the picture.
        """
        strap = yield from self._strap_from(far)
        if np.linalg.norm(strap.position_in_map - far.position_in_map) < self.tuning.centring_tolerance:
            return strap
        try:
            return (yield from self._strap_from(strap))
        except (PerceptionFailure, MotionError):
            return strap

    def _strap_from(self, far: SleeveOpening) -> Generator[None, None, SleeveOpening]:
        """The strap as the hand's camera sees it from the first of the views of `far` in which it shows."""
        unreachable, hidden = Tries(MotionError), Tries(PerceptionFailure)
        for pose in strap_views(self.world.robot, far, self.side, self.hand, self.world.room.bed):
            with unreachable:
                speed = careful(self, self.tuning.view_speed)
                yield from move_hands(self, {self.hand: pose}, way="any", speed=speed)
                yield from self.wait(SLEEVE_SEARCH.settle_time)
                with hidden:
                    return self.context.senses.sleeve_strap(
                        self.world.look(f"{self.hand}_hand"),
                        side=self.side,
                        near_in_map=far.position_in_map,
                    )
        raise hidden.last if hidden.problems else unreachable.first

"""Stage C: take hold of a sleeve by the strap of its armhole."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..sim.world import Side
from .belief.person_tracking import careful, watch_arm
from .belief.sleeve_search import SLEEVE_SEARCH, look_for_sleeve, seen_well, strap_views
from .belief.strap_grasp import way_in
from .control.compliant_hold import while_holding
from .control.hands import hand_now, move_hands, open_gripper
from .control.pinch import back_off, pinch
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import ArmPath
from .geometry.hold import Hold
from .geometry.strap_grip import StrapGrip, strap_grip
from .motion.errors import MotionError

AIMED = 0.05  # a strap that far from the middle of the picture is looked at again [m]
OPENING = 0.06  # of the fingers around the strap, which is 55 mm wide [m]


class GraspSleeve(Skill):
    """Finds the armhole with the head camera, looks at its strap with the hand's camera, and pinches the strap.

    Inputs: `side` of the person; `hand` that grasps; `hold`, the hand that holds the arm meanwhile, or None; `worn`,
    whether the sleeve is over the person's hand already, so that it need not be brought before the fingertips.
    Output: `grip`, how the strap lies in the fingers.  A miss ends with the hand open and drawn back.
    """

    side = Input(Side)
    hand = Input(Side)
    hold = Input(Hold, default=None)
    worn = Input(bool, default=False)
    grip = Output(StrapGrip)
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.ARM_SLIPPED,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Grasp, easing the hold of the arm on every tick."""
        yield from while_holding(self, self.hold, self._grasp())

    def _grasp(self) -> Iterator[None]:
        """Look, reach in, pinch."""
        self.note(f"looks for the {self.side} sleeve")
        strap = yield from self._look()
        self.note(f"takes the {self.side} sleeve")
        path = ArmPath.of(watch_arm(self, self.side, hold=self.hold))
        way = way_in(self, self.side, self.hand, strap, path, worn=self.worn)
        yield from move_hands(self, {self.hand: way.before}, speed=careful(self, 0.3), way="either")
        yield from open_gripper(self, self.hand, OPENING)
        seen_well(self).pop(self.side, None)
        yield from move_hands(self, {self.hand: way.inside}, speed=0.12, way="either")
        pose = hand_now(self, self.hand)
        try:
            yield from pinch(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from back_off(self, self.hand)
            raise
        self.grip = strap_grip(self.side, self.hand, strap, pose)

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
        if np.linalg.norm(strap.position_in_map - far.position_in_map) < AIMED:
            return strap
        try:
            return (yield from self._strap_from(strap))
        except (PerceptionFailure, MotionError):
            return strap

    def _strap_from(self, far: SleeveOpening) -> Generator[None, None, SleeveOpening]:
        """The strap as the hand's camera sees it from the first of the views of `far` in which it shows."""
        problem: PerceptionFailure | MotionError | None = None
        for pose in strap_views(far, self.side, self.hand, self.world.room.bed):
            try:
                yield from move_hands(self, {self.hand: pose}, way="any", speed=careful(self, 0.5))
            except MotionError as stop:
                problem = problem or stop
                continue
            yield from self.wait(SLEEVE_SEARCH.settle_time)
            try:
                return self.context.senses.sleeve_strap(
                    self.world.look(f"{self.hand}_hand"),
                    side=self.side,
                    near_in_map=far.position_in_map,
                )
            except PerceptionFailure as stop:
                problem = stop
        assert problem is not None
        raise problem

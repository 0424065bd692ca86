"""Stage C: carry the second arm's sleeve back to its own side of the bed, from which the first pull has drawn it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import SleeveOpening
from ..sim.world import Frame, Side
from .belief.person_tracking import careful
from .belief.sleeve_search import SleeveMemory
from .control.base import drive_to
from .control.hands import hand_now, look_towards, move_hands, open_gripper, until_load
from .control.pinch import back_off, pinch, reach_in
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD, LIFTING, STANCES, outwards
from .motion.errors import MotionError
from .scripted.scripted_person import laid_strap
from .scripted.scripted_senses import ScriptedSenses

STRAY = (0.28, 0.35)  # about where such a sleeve lies: beyond the bed's middle, feetward of it [m]
WRONG_SIDE = 0.02  # beyond the bed's middle [m]
LAID = (0.33, 0.16, 0.06)  # where it is laid down: outwards of the bed's middle, feetward, above it [m]
ABOVE, SPEED = 0.25, 0.25  # height of the way across [m], [m/s]
TAUT = 5.0  # load, weight and all, from which it goes no farther: the other sleeve is on its arm [N]
_OPENING, BACK = 0.06, 0.3  # of the fingers; of the base from the sleeve it has laid down [m]


class CarryAcross(Skill):
    """Looks for the sleeve beyond the middle of the bed; takes it there from above and lays it beyond the arm's hand.

    A sleeve that does not lie there is no failure.

    Inputs: `side` of the person whose sleeve it is; the robot stands on the other side of the bed.
    """

    side = Input(Side)
    reasons = (
        Reason.PATH_BLOCKED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.COMMAND_LOST,
        Reason.TIMEOUT,
    )

    def steps(self) -> Iterator[None]:
        """Look; drive, take, carry, let go, drive back."""
        self.note(f"looks whether the {self.side} sleeve is on its side")
        yield from look_towards(self, self._place(-STRAY[0], STRAY[1], 0.0))
        seen = self._stray()
        if seen is None:
            return
        self.note(f"carries the {self.side} sleeve across")
        hand, place = LIFTING[self.side], seen.position_in_map
        lane = np.array((-STANCES.lane * outwards(self.side)[0], place[1] + STANCES.ahead, STANCES.heading))
        yield from drive_to(self, lane)
        yield from reach_in(self, hand, place, -UP, seen.closing_in_map, opening=_OPENING)
        try:
            yield from pinch(self, hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, hand)
                yield from back_off(self, hand)
            raise
        yield from self._carry(hand)
        yield from drive_to(self, lane - BACK * np.append(HEADWARD[:2], 0.0), straight=True, retreat=True)

    def _place(self, out: float, feetward: float, above: float) -> np.ndarray:
        """(3,) from the middle of the mattress [m]."""
        bed = self.world.room.bed
        middle = np.array((*bed[:, :2].mean(axis=0), bed[1, 2]))
        return middle + out * outwards(self.side) - feetward * HEADWARD + above * UP

    def _stray(self) -> SleeveOpening | None:
        """The sleeve, where it lies beyond the middle of the bed."""
        near = self._place(-STRAY[0], STRAY[1], 0.0)
        try:
            seen = self.context.senses.sleeve_opening(self.world.look("head"), side=self.side, near_in_map=near)
        except PerceptionFailure:
            return None
        out = float((seen.position_in_map - self._place(0.0, 0.0, 0.0)) @ outwards(self.side))
        return seen if out < -WRONG_SIDE else None

    def _carry(self, hand: Side) -> Iterator[None]:
        """Up, across, down, as far as the sleeve goes; let go of it and rise."""
        memory = self.context.memory.of(SleeveMemory, SleeveMemory)
        memory.sleeves.pop(self.side, None)
        out, feetward, above = LAID
        for there in (
            hand_now(self, hand)[:3, 3] + ABOVE * UP,
            self._place(out, feetward, above + ABOVE),
            self._place(out, feetward, above),
        ):
            pose = hand_now(self, hand)
            pose[:3, 3] = there
            motion = move_hands(self, {hand: pose}, speed=careful(self, SPEED), free="any", way="either")
            yield from until_load(self, hand, TAUT, motion)
        memory.last[self.side] = hand_now(self, hand)[:3, 3]
        yield from open_gripper(self, hand)
        with suppress(MotionError):  # it is open, and the next motion begins with a way out
            yield from back_off(self, hand)


class _StraySleeve(ScriptedSenses):
    """Sees every sleeve on the right side of the bed."""

    def sleeve_opening(self, frame: Frame, *, side: Side, near_in_map: np.ndarray) -> SleeveOpening:
        return laid_strap("right", frame.stamp)

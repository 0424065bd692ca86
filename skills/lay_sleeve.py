"""Stage C: put a sleeve that hangs wrong back on the bed, so that its back panel comes to lie outwards of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .belief.person_tracking import careful
from .control.compliant_hold import while_holding
from .control.fingers import open_gripper
from .control.hands import hand_now, move_hands, until_load
from .control.pinch import back_off
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.hold import Hold
from .geometry.stances import HEADWARD, outwards
from .geometry.strap_grip import StrapGrip
from .motion.errors import MotionError

LAID = np.array((0.36, 0.14, 0.06))  # of the strap: outwards of and feetward from the bed's middle, above it [m]
ABOVE, ASIDE, BEFORE = 0.30, 0.16, 0.12  # where the way down begins: higher, farther out, farther towards the feet [m]
SPEED = 0.25  # [m/s]
TAUT = 3.5  # load from which the sleeve goes no farther: the other one may be on its arm already [N]


class LaySleeve(Skill):
    """Hangs the sleeve out over the edge of the bed, then lowers it inwards and headward, and lets go.

    What hangs below the strap touches the bed first, outwards of where the strap then comes to lie.

    Inputs: `grip`, how the strap is held; `hold`, the hand that holds the arm, or None.
    """

    grip = Input(StrapGrip)
    hold = Input(Hold, default=None)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.ARM_SLIPPED, Reason.FORCE_LIMIT)

    def steps(self) -> Iterator[None]:
        """Out, down, open, back."""
        self.note(f"lays the {self.grip.arm} sleeve down again")
        yield from while_holding(self, self.hold, self._lay())

    def _lay(self) -> Iterator[None]:
        hand, out, bed = self.grip.hand, outwards(self.grip.arm), self.world.room.bed
        middle = np.array((*bed[:, :2].mean(axis=0), bed[1, 2]))
        laid = middle + LAID[0] * out - LAID[1] * HEADWARD + LAID[2] * UP
        for place in (laid + ABOVE * UP + ASIDE * out - BEFORE * HEADWARD, laid):
            pose = hand_now(self, hand)
            pose[:3, 3] = place
            motion = move_hands(self, {hand: pose}, speed=careful(self, SPEED), free="any", way="either")
            yield from until_load(self, hand, TAUT, motion)
        yield from open_gripper(self, hand)
        try:
            yield from back_off(self, hand)
        except MotionError:
            return  # it is open, and the next motion begins with a way out

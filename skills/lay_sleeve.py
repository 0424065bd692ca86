"""Put a held sleeve back on the bed, so that its back panel comes to lie outwards of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_motion import while_person_rests
from .belief.person_tracking import careful
from .belief.refused_stands import refused_stands
from .control.compliant_hold import while_holding
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands, until_load
from .control.pinch import back_off
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.hold import Hold
from .geometry.stances import HEADWARD, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LaySleeveTuning(Quantities):
    """Numbers of `LaySleeve`."""

    laid_outwards: float = quantity(
        0.26,
        "m",
        "from the bed's middle line to the laid strap",
        "measured: at 0.36 m the half of the gown that then hung over the edge of the bed drew the rest after it (118)",
    )
    laid_feetward: float = quantity(
        0.20, "m", "from the bed's middle towards the feet to the laid strap", "choice: beyond the resting hand"
    )
    laid_height: float = quantity(0.06, "m", "of the laid strap above the mattress", "choice: the fingers stay clear")
    start_height: float = quantity(
        0.30, "m", "of the start of the way down above its end", "choice: what hangs below the strap is off the arm"
    )
    start_outwards: float = quantity(
        0.16, "m", "from the end of the way down outwards to its start", "choice: the back panel touches down outwards"
    )
    start_feetward: float = quantity(
        0.12, "m", "from the end of the way down towards the feet to its start", "choice: the sleeve trails feetward"
    )
    speed: float = quantity(0.25, "m/s", "of the hand", "choice: slow beside the person")
    max_load: float = quantity(
        3.5, "N", "of the sleeve, at which the hand goes no farther", "choice: the other sleeve may be on its arm"
    )
    more_load: float = quantity(
        0.5,
        "N",
        "likewise, beyond what pulls at the hand before it moves, where that is more",
        "measured: at 5 N beside a hand that it had missed, a sleeve was let go of 0.6 m above the bed (195); the way "
        "down slackens it",
    )


class LaySleeve(Skill):
    """Holds the sleeve out towards the edge of the bed, then lowers it inwards and headward, and lets go.

    What hangs below the strap touches the bed first, outwards of where the strap then comes to lie.  A hand that cannot
    draw back after opening is no failure; a person who moves is one.
    """

    side = Input(Side, doc="arm of the person that the sleeve belongs to")
    hand = Input(Side, doc="hand that holds its strap")
    hold = Input(Hold, doc="the hand that holds the arm, or None", default=None)
    tuning = Input(LaySleeveTuning, default=LaySleeveTuning(), doc="numbers of this skill")
    reasons = (
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.COMMAND_LOST,
        Reason.ARM_SLIPPED,
        Reason.PERSON_MOVED,
        Reason.FORCE_LIMIT,
    )

    def steps(self) -> Iterator[None]:
        """Lay the sleeve down as long as the person does not move."""
        self.note(f"lays the {self.side} sleeve down again")
        yield from while_person_rests(self, while_holding(self, self.hold, self._lay()))

    def _lay(self) -> Iterator[None]:
        """Out, down, open, back."""
        tuning = self.tuning
        hand, out, bed = self.hand, outwards(self.side), self.world.room.bed
        middle = np.array((*bed[:, :2].mean(axis=0), bed[1, 2]))
        laid = middle + tuning.laid_outwards * out - tuning.laid_feetward * HEADWARD + tuning.laid_height * UP
        above = laid + tuning.start_height * UP + tuning.start_outwards * out - tuning.start_feetward * HEADWARD
        for place in (above, laid):
            pose = hand_now(self, hand)
            pose[:3, 3] = place
            most = max(tuning.max_load, float(np.linalg.norm(cloth_load(self, hand))) + tuning.more_load)
            motion = move_hands(self, {hand: pose}, speed=careful(self, tuning.speed), free="any", way="either")
            yield from until_load(self, hand, most, motion)
        yield from open_gripper(self, hand)
        refused_stands(self, self.side).clear()
        try:
            yield from back_off(self, hand)
        except MotionError:
            return  # it is open, and the next motion begins with a way out

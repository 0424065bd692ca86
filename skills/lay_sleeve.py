"""Put a held sleeve back on the bed, so that its back panel comes to lie outwards of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.quantity import Quantities, quantity
from ..sim.world import SensorLost, Side
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
    most_overhang: float = quantity(
        0.55,
        "1",
        "share of the gown beyond that edge of the bed, from which on it is drawn back over the person",
        "measured: told to 0.05 in six states of four runs; laid beyond the hand, one with 0.74 beyond it slid to "
        "the floor (154), those with 0.14 to 0.37 stayed (0, 138)",
    )
    laid_over: tuple[float, float, float] = quantity(
        (0.10, 0.20, 0.26),
        "m",
        "where its strap is laid then: outwards and feetward from the bed's middle, and above the mattress",
        "choice: over the thigh on its own side; 0.20 m farther, the gown stayed on the bed, 0.16 of it beyond the "
        "edge, 0.80 before, but turned over, its sleeve on the other side (154)",
    )
    most_load_over: float = quantity(
        5.0, "N", "at which it is drawn back no farther", "choice: as one that is carried across the bed"
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

    What hangs below the strap touches the bed first, outwards of where the strap then comes to lie.  A gown of which
    too much lies beyond that edge of the bed would slide off it: it is drawn back over the person by the strap.  A hand
    that cannot draw back after opening is no failure; a person who moves is one.
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
        tuning, hand = self.tuning, self.hand
        load, places = self._way()
        for place in places:
            pose = hand_now(self, hand)
            pose[:3, 3] = place
            most = max(load, float(np.linalg.norm(cloth_load(self, hand))) + tuning.more_load)
            motion = move_hands(self, {hand: pose}, speed=careful(self, tuning.speed), free="any", way="either")
            yield from until_load(self, hand, most, motion)
        yield from open_gripper(self, hand)
        refused_stands(self, self.side).clear()
        try:
            yield from back_off(self, hand)
        except MotionError:
            return  # it is open, and the next motion begins with a way out

    def _way(self) -> tuple[float, tuple[np.ndarray, np.ndarray]]:
        """The load at which the hand goes no farther [N]; where it begins to come down, and lets go, (3,) each [m]."""
        tuning, out, bed = self.tuning, outwards(self.side), self.world.room.bed
        middle = np.array((*bed[:, :2].mean(axis=0), bed[1, 2]))
        if self._overhang() > tuning.most_overhang:
            outward, feetward, height = tuning.laid_over
            laid = middle + outward * out - feetward * HEADWARD + height * UP
            self.note(f"draws the gown back over the person with the {self.side} sleeve")
            return tuning.most_load_over, (laid + tuning.start_height * UP, laid)
        laid = middle + tuning.laid_outwards * out - tuning.laid_feetward * HEADWARD + tuning.laid_height * UP
        above = laid + tuning.start_height * UP + tuning.start_outwards * out - tuning.start_feetward * HEADWARD
        return tuning.max_load, (above, laid)

    def _overhang(self) -> float:
        """Share of the gown beyond the edge of the bed on that side; 0 where it does not show."""
        try:
            return self.context.senses.overhang(self.world.look("head"), side=self.side).share
        except (PerceptionFailure, SensorLost):
            return 0.0

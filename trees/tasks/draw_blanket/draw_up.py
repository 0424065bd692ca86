"""Draw the edge of a blanket that a hand holds up to the person's chest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.control.base import drive_to
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import hand_now, until_load
from ....skills.control.withdraw import withdraw
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import HEADWARD


@dataclass(frozen=True, kw_only=True)
class DrawUpTuning(Quantities):
    """Numbers of `DrawUp`."""

    below_shoulders: float = quantity(
        0.22, "m", "of the edge from the line of the shoulders in the end", "design: on the chest, clear of the throat"
    )
    lift: float = quantity(0.20, "m", "of the edge before it is drawn", "choice: it clears the person's arm")
    speed: float = quantity(0.12, "m/s", "of the base while the edge is drawn", "choice: slow beside the person")
    max_load: float = quantity(
        9.0, "N", "of the blanket, at which it is drawn no farther", "choice: it weighs 6 N, and 18 N stop the robot"
    )
    laid: float = quantity(
        0.15,
        "m",
        "above the shoulder, where the edge is let go of",
        "measured: at 0.05 m the hand met the side of the trunk with 64 N (101); it falls from there",
    )
    carry: Carry = field(default_factory=lambda: Carry(speed=0.12, max_load=15.0))
    opening: float = quantity(0.04, "m", "of the fingers that let it go", "choice: just enough; they are near the arm")
    withdrawal: float = quantity(0.15, "m", "by which the open hand is drawn back", "choice: clear of the blanket")


class DrawUp(Skill):
    """Lifts the edge over the person's arm, drives along the bed until it is at the chest, and lays it down there.

    The hand stays where it is before the robot, the base does the way: it may be long.  A blanket that pulls hard, by
    what the other side has been drawn to, is laid down where it is.
    """

    side = Input(Side, doc="of the bed, the person's own left or right")
    hand = Input(Side, doc="hand of the robot that holds the edge")
    inset = Input(float, unit="m", default=0.0, doc="of the hand from the edge, which lies so far ahead of it")
    tuning = Input(DrawUpTuning, default=DrawUpTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.PATH_BLOCKED,
        Reason.MOTION_BLOCKED,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Lift, drive, lay down, let go."""
        tuning = self.tuning
        self.note(f"draws the blanket up on the {self.side}")
        shoulder = watch_arm(self, self.side, period=0.0).points_in_map[0]
        here = hand_now(self, self.hand)[:3, 3]
        yield from carry(self, self.hand, here + tuning.lift * UP, tuning.carry)
        way = (shoulder - hand_now(self, self.hand)[:3, 3]) @ HEADWARD - tuning.below_shoulders - self.inset
        pose = self.world.observe().pose_base_in_map
        goal = pose + way * np.append(HEADWARD[:2], 0.0)
        draws = drive_to(self, goal, straight=True, speed=tuning.speed)
        yield from until_load(self, self.hand, tuning.max_load, draws)
        here = hand_now(self, self.hand)[:3, 3]
        yield from carry(self, self.hand, np.append(here[:2], shoulder[2] + tuning.laid), tuning.carry)
        yield from open_gripper(self, self.hand, tuning.opening)
        yield from withdraw(self, [self.hand], tuning.withdrawal)

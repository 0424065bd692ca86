"""Lay a towel that hangs from one hand across the person's hand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ....perception.image.cloud import unit
from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.control.base import BaseTuning, stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import hand_now, move_hands
from ....skills.control.withdraw import withdraw
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP, ArmPath
from ....skills.geometry.stances import outwards


@dataclass(frozen=True, kw_only=True)
class LayOnHandTuning(Quantities):
    """Numbers of `LayOnHand`."""

    coordinate: float = quantity(2.5, "1", "arm coordinate that the towel is laid across", "design: the hand's middle")
    stand: BaseTuning = field(default_factory=lambda: BaseTuning(ease=(0.92, 0.22)))
    way: tuple[tuple[float, float], tuple[float, float], tuple[float, float], tuple[float, float]] = quantity(
        ((-0.19, 0.50), (-0.19, 0.25), (-0.06, 0.20), (0.05, 0.08)),
        "m",
        "of the fingertips, out from the person's hand and up: the towel's end comes down between hand and legs first",
        "measured: begun on the robot's side, or drawn 0.12 m beyond the hand, the towel slid off the bed (100, 120)",
    )
    speed: float = quantity(0.2, "m/s", "of the hand until then", "choice: the towel hardly swings")
    carry: Carry = field(default_factory=lambda: Carry(speed=0.10, max_load=6.0))
    withdrawal: float = quantity(0.15, "m", "by which the open hand is drawn back", "choice: clear of the towel")


class LayOnHand(Skill):
    """Stands before the person's hand, lets the towel's end come down behind it and draws the other end back across.

    It fails where the arm is not seen or the way is out of reach; the hand then still holds the towel.
    """

    side = Input(Side, doc="arm of the person")
    hand = Input(Side, doc="hand of the robot that holds the towel")
    tuning = Input(LayOnHandTuning, default=LayOnHandTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.PATH_BLOCKED,
        Reason.MOTION_BLOCKED,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Stand, over it, down and across, let go."""
        tuning = self.tuning
        self.note(f"lays the towel on the person's {self.side} hand")
        path = ArmPath.of(watch_arm(self, self.side, period=0.0))
        place = path.point(tuning.coordinate)
        across = unit(np.cross(path.hand_direction, UP))
        across = across * np.sign(across @ outwards(self.side))
        yield from stand_for(self, self.hand, place, tuning=tuning.stand)
        way = [place + out * across + up * UP for out, up in tuning.way]
        first = hand_now(self, self.hand)
        first[:3, 3] = way[0]
        yield from move_hands(self, {self.hand: first}, speed=tuning.speed, free="any", way="either")
        for point in way[1:]:
            yield from carry(self, self.hand, point, tuning.carry)
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], tuning.withdrawal)

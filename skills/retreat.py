"""Let go of everything, draw the hands back, and take the robot away from the person."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Hands, Observation, Side
from .belief.person_tracking import careful
from .control.base import drive_to
from .control.fingers import FINGERS, open_gripper
from .control.hands import move_arms
from .control.ready import Ready, ready_or_not
from .control.withdraw import WithdrawTuning, withdraw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class RetreatTuning(Quantities):
    """Numbers of the way back."""

    withdraw: WithdrawTuning = field(default_factory=WithdrawTuning)
    arm_opening: float = quantity(
        0.06, "m", "of fingers, below which no arm is between them", "choice: an adult's forearm is thicker"
    )
    pressed_load: float = quantity(
        12.0, "N", "on a hand, from which it rests on something: cloth pulls with less", "measured: at most 10 N"
    )
    eased: float = quantity(
        0.02, "m", "such a hand goes back before its fingers open", "choice: they spread by 2 cm each, and push with it"
    )
    base_speed: float = quantity(0.3, "m/s", "of the base as it backs off", "choice: slow beside the bed")
    ready_speed: float = quantity(
        0.5, "m/s", "of the hands on their way to the ready posture, away from the person", "choice: quick in the open"
    )


class Retreat(Skill):
    """Opens the hands, draws them back the way they point, backs off, and brings the arms into the ready posture.

    Safe from any state: opening comes first, and drawing back needs no plan.
    It fails where a command is lost, or where something is in the way of the base or of the ready posture.
    """

    hands = Input(Hands, default="both", doc="hands that are opened and drawn back")
    hand_distance = Input(float, unit="m", default=0.15, doc="how far the hands are drawn back")
    base_distance = Input(float, unit="m", default=0.0, doc="how far the base then backs off")
    ready = Input(Ready, default="always", doc="whether the arms go to the ready posture in the end")
    tuning = Input(RetreatTuning, default=RetreatTuning(), doc="numbers of this skill")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Open, draw back, back off, ready."""
        yield from ready_or_not(self, self.ready, self._back)

    def _first_opening(self, seen: Observation, side: Side) -> float:
        """Just enough for cloth to slip out; fingers that are open already stay so: beside the person they would push.

        Opened wide where the hand had met a leg with 93 N, they pushed it with 145 N (147).
        """
        tuning, now = self.tuning, float(seen.gripper_opening[SIDES.index(side)])
        if self.hand_distance > 0.0 and now < tuning.arm_opening:
            return max(now, FINGERS.cloth_opening)
        return self.world.robot.gripper.stroke

    def _rests(self, seen: Observation, side: Side) -> bool:
        """Whether a hand that holds no arm rests on something.

        One that had seated a sleeve with 21 N pressed the trunk with 88 N as its fingers opened (193).
        """
        n = SIDES.index(side)
        load = float(np.linalg.norm(seen.wrench_hand_in_map[n, :3]))
        return load > self.tuning.pressed_load and float(seen.gripper_opening[n]) < self.tuning.arm_opening

    def _back(self, ready: bool) -> Iterator[None]:
        tuning = self.tuning
        sides: list[Side] = [side for side in SIDES if self.hands in (side, "both")]
        self.note("lets go and draws back")
        for side in sides:
            seen = self.world.observe()
            if self.hand_distance > 0.0 and self._rests(seen, side):
                yield from withdraw(self, [side], tuning.eased, tuning.withdraw)
            yield from open_gripper(self, side, self._first_opening(seen, side))
        if self.hand_distance > 0.0:
            yield from withdraw(self, sides, self.hand_distance, tuning.withdraw)
        for side in sides:
            yield from open_gripper(self, side)
        if self.base_distance > 0.0:
            x, y, yaw = self.world.observe().pose_base_in_map
            goal = np.array((x - self.base_distance * math.cos(yaw), y - self.base_distance * math.sin(yaw), yaw))
            yield from drive_to(self, goal, straight=True, speed=tuning.base_speed, retreat=True)
        if ready:
            speed = careful(self, tuning.ready_speed)
            yield from move_arms(self, self.world.robot.ready, sides=tuple(sides), speed=speed, retreat=True)

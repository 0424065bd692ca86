"""Let go of everything, draw the hands back, and take the robot away from the person."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from ..sim.robot import model
from ..sim.world import SIDES, HandTwist, Side
from .belief.person_tracking import careful
from .control.base import drive_to
from .control.hands import hand_now, move_arms, open_gripper
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP

Hands = Literal["left", "right", "both"]
_SPEED = 0.12  # of the hands on their way back [m/s]
_BASE_SPEED = 0.3  # [m/s]


class Retreat(Skill):
    """Opens the hands, draws them back the way they point, backs off, and brings the arms into the ready posture.

    Safe from any state: opening comes first, and drawing back needs no plan.

    Inputs: `hands` to open; `clear`, how far they are drawn back [m]; `back`, how far the base then backs off [m];
    `ready`, whether the arms go to the ready posture in the end.
    """

    hands = Input(Hands, default="both")
    clear = Input(float, default=0.15)
    back = Input(float, default=0.0)
    ready = Input(bool, default=True)
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Open, draw back, back off, ready."""
        sides: list[Side] = [side for side in SIDES if self.hands in (side, "both")]
        self.note("lets go and draws back")
        for side in sides:
            yield from open_gripper(self, side)
        if self.clear > 0.0:
            yield from withdraw(self, sides, self.clear)
        if self.back > 0.0:
            x, y, yaw = self.world.observe().pose_base_in_map
            goal = np.array((x - self.back * np.cos(yaw), y - self.back * np.sin(yaw), yaw))
            yield from drive_to(self, goal, straight=True, speed=_BASE_SPEED, retreat=True)
        if self.ready:
            yield from move_arms(self, model.READY, sides=tuple(sides), speed=careful(self, 0.5), retreat=True)


def withdraw(skill: Skill, sides: list[Side], distance: float) -> Iterator[None]:
    """Draw hands back by `distance` [m] against the way they point, or straight up where that is not upwards."""
    directions = {}
    for side in sides:
        back = -hand_now(skill, side)[:3, 2]
        directions[side] = back if back[2] > 0.3 else UP
    end = skill.now() + distance / _SPEED
    while skill.now() < end:
        for side, back in directions.items():
            twist = np.append(_SPEED * back, np.zeros(3))
            skill.world.send(HandTwist(side=side, twist_in_map=twist), retreat=True)
        yield
    yield from skill.wait(0.3)

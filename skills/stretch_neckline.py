"""Stage B: the two hands that hold the shoulders of the gown draw apart until the neckline is taut."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.robot.kinematics import planar_pose
from ..sim.world import SIDES, HandTwist
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill, SkillFailure

AHEAD, HEIGHT, START = 0.62, 1.36, 0.22  # where the hands begin: before the base, above the floor, half apart [m]
SPEED = 0.08  # of each hand when it draws [m/s]
LONGEST = 6.0  # for drawing; the hands are then as far apart as they get [s]
SLACK_WEIGHT = 0.8  # a hand that carries less has lost the gown [N]


class StretchNeckline(Skill):
    """Raises both hands before the chest and draws them apart until the cloth between them pulls back.

    Inputs: `pull`, the horizontal load at which the neckline counts as taut [N]; `widest`, where to stop at the
    latest [m].  Outputs: `width` between the hands [m].
    """

    pull = Input(float, default=1.4)
    widest = Input(float, default=0.92)
    width = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.CLOTH_SLIPPED)

    def steps(self) -> Iterator[None]:
        """Raise, draw, settle."""
        self.note("draws the gown taut")
        base = planar_pose(self.world.observe().pose_base_in_map)
        goals = {}
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            pose = hand_now(self, side)
            pose[:3, 3] = (base @ np.array((AHEAD, sign * START, HEIGHT, 1.0)))[:3]
            goals[side] = pose
        yield from move_hands(self, goals, speed=0.35, free="any", way="any")
        end = self.now() + LONGEST
        outwards = {"left": base[:3, 1], "right": -base[:3, 1]}
        while True:
            apart = hand_now(self, "left")[:3, 3] - hand_now(self, "right")[:3, 3]
            width = float(np.linalg.norm(apart))
            loads = {side: cloth_load(self, side) for side in SIDES}
            light = [side for side in SIDES if np.linalg.norm(loads[side]) < SLACK_WEIGHT]
            if light and width > 2 * START + 0.1:
                raise SkillFailure(Reason.CLOTH_SLIPPED, f"the {light[0]} hand carries nothing")
            pulled = min(-loads[side] @ outwards[side] for side in SIDES)
            if self.now() > end or width > self.widest or pulled > self.pull:
                break
            for side in SIDES:
                self.world.send(HandTwist(side=side, twist_in_map=np.append(SPEED * outwards[side], np.zeros(3))))
            yield
        self.world.stop()
        yield from self.wait(0.5)
        self.width = width

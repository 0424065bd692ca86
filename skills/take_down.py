"""Stage A: both hands lift the gown off its hook and carry it away from the rail."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.estimates import GraspPoint
from ..sim.robot.kinematics import planar_pose
from ..sim.world import SIDES
from .control.base import drive_to
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill

ANGLES = (-35.0, -5.0, 10.0, 20.0, 30.0, 40.0)  # of the neckline from the hook to each hand, above level [degrees]
SLACK = 0.95  # how much of that distance the hands use: the hook may not pull at them
CLOSE = 0.03  # of the hands before the hook, on the robot's side [m]
SETTLED = 0.12  # a load that has grown by less since the last step grows no more [N]
BACK = 0.30  # from the rail [m]


class TakeDown(Skill):
    """Raises both hands on arcs about the hook until they carry the whole gown, then drives back from the rail.

    Each hand keeps its distance from the hook, so the neckline is neither stretched nor dropped.

    Inputs: `hook`; `weight`, what the hands must carry together, and `each` at least [N].  Outputs: `load` they carry
    [N].
    """

    hook = Input(GraspPoint)
    weight = Input(float, default=2.8)
    each = Input(float, default=0.6)
    load = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED)

    def steps(self) -> Iterator[None]:
        """Raise, weigh, again; drive back, weigh again."""
        self.note("lifts the gown off the rail")
        base = planar_pose(self.world.observe().pose_base_in_map)
        hook = self.hook.position_in_map - CLOSE * base[:3, 0]
        reach = {side: SLACK * float(np.linalg.norm(hand_now(self, side)[:3, 3] - hook)) for side in SIDES}
        carried = self._carried()
        for angle in np.deg2rad(ANGLES):
            goals = {}
            for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
                pose = hand_now(self, side)
                pose[:3, 3] = hook + reach[side] * (sign * np.cos(angle) * base[:3, 1] + np.sin(angle) * base[:3, 2])
                goals[side] = pose
            yield from move_hands(self, goals, speed=0.25, free="any", way="either")
            yield from self.wait(0.3)
            before, carried = carried, self._carried()
            if angle > 0.0 and carried > self.weight and carried - before < SETTLED:
                break
        here = self.world.observe().pose_base_in_map
        back = here.copy()
        back[:2] -= BACK * base[:2, 0]
        yield from drive_to(self, back, straight=True, speed=0.3)
        yield from self.wait(0.5)
        self.load = self._carried()
        least = min(-float(cloth_load(self, side)[2]) for side in SIDES)
        if self.load < self.weight or least < self.each:
            raise SkillFailure(Reason.GRASP_MISSED, f"the hands carry {self.load:.1f} N, one of them {least:.1f} N")

    def _carried(self) -> float:
        return float(-sum(cloth_load(self, side)[2] for side in SIDES))

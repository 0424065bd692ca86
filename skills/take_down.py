"""Stage A: both hands lift the gown off its hook and carry it away from the rail."""

from __future__ import annotations

from collections.abc import Iterator

from ..sim.robot.kinematics import planar_pose
from ..sim.world import SIDES
from .context import Context
from .driving import drive_to
from .hands import cloth_load, hand_now, move_hands
from .ports import Input, Output
from .reasons import Reason, SkillFailure
from .skill import Skill

RAISE = (0.15, 0.30, 0.42)  # of both hands, step by step until they carry the gown [m]
APART = 0.05  # by how much each hand moves outwards in a step [m]
BACK = 0.55  # from the rail [m]


class TakeDown(Skill):
    """Raises both hands until they carry the gown's weight, then drives back from the rail.

    Inputs: `weight`, what the hands must carry together [N].  Outputs: `load` they carry [N].
    """

    weight = Input(float, default=2.8)
    load = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED)

    def steps(self) -> Iterator[None]:
        """Raise, weigh, again; drive back, weigh again."""
        self.note("lifts the gown off the rail")
        base = planar_pose(self.world.observe().pose_base_in_map)
        starts = {side: hand_now(self, side) for side in SIDES}
        for step, height in enumerate(RAISE, start=1):
            goals = {}
            for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
                pose = starts[side].copy()
                pose[:3, 3] += (0.0, 0.0, height) + sign * step * APART * base[:3, 1]
                pose[2, 3] = min(pose[2, 3], 1.62)
                goals[side] = pose
            yield from move_hands(self, goals, speed=0.2, free="any", way="either")
            yield from self.wait(0.4)
            if self._carried() > self.weight:
                break
        here = self.world.observe().pose_base_in_map
        back = here.copy()
        back[:2] -= BACK * base[:2, 0]
        yield from drive_to(self, back, straight=True, speed=0.3)
        yield from self.wait(0.5)
        self.load = self._carried()
        if self.load < self.weight:
            raise SkillFailure(Reason.GRASP_MISSED, f"the hands carry {self.load:.1f} N")

    def _carried(self) -> float:
        return float(-sum(cloth_load(self, side)[2] for side in SIDES))

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        return cls("take down", context, weight=-1.0)

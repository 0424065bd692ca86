"""Stage B: stretch the gown by the two corners of its neckline until the neckline is straight."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.robot.kinematics import default_kinematics, planar_pose
from ..sim.world import Side
from .context import Context
from .hands import hand_now, move_hands
from .motion.ik import hand_pose
from .motion.reach import plan_hand_line
from .ports import Input, Output
from .reasons import Reason, SkillFailure
from .skill import Skill

AHEAD, HEIGHT = 0.72, 1.28  # where the hands meet, in base [m]
SLACK = 0.62  # distance of the hands at which no gown's neckline is taut yet [m]
WIDEST = 0.95  # no gown's neckline is longer [m]
SHORTEST = 0.70  # a neckline that is taut already here is not held by both its corners [m]


class DrawTaut(Skill):
    """Brings both hands to the same height and draws them apart until the neckline pulls.

    Inputs: `tension`, along the neckline, that ends the motion [N]; `speed` of each hand meanwhile [m/s].
    Output: `width`, the distance of the hands then [m].
    """

    tension = Input(float, default=1.2)
    speed = Input(float, default=0.06)
    width = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.CLOTH_SLIPPED,
               Reason.MULTI_LAYER)

    def steps(self) -> Iterator[None]:
        """Bring the hands up, draw, stop in time, look."""
        self.note("brings the hands to the same height")
        yield from move_hands(self, self._goals(SLACK), speed=0.3, free="approach", way="any")
        yield from self.wait(0.5)
        at_rest = self._tension()
        self.note("draws the neckline taut")
        seen = self.world.observe()
        self.world.send(plan_hand_line(default_kinematics(), self._goals(WIDEST), seen.arm_positions,
                                       seen.pose_base_in_map, free="approach", hand_speed=self.speed))
        while self._tension() - at_rest < self.tension:
            if self._width() > WIDEST - 0.01:
                raise SkillFailure(Reason.CLOTH_SLIPPED, f"the hands are {self._width():.2f} m apart and nothing pulls")
            yield
        self.world.stop()
        yield from self.until(self.context.guard.still, timeout=2.0, reason=Reason.MOTION_BLOCKED)
        width = self._width()
        if width < SHORTEST:
            raise SkillFailure(Reason.MULTI_LAYER, f"the neckline pulls at {width:.2f} m already")
        self.note(f"taut at {width:.2f} m")
        self.width = width

    def _goals(self, width: float) -> dict[Side, np.ndarray]:
        """Hand poses `width` apart, pointing down, closing across the robot's view."""
        base = planar_pose(self.world.observe().pose_base_in_map)
        down, across = np.array((0.0, 0.0, -1.0)), np.array((1.0, 0.0, 0.0))
        return {side: base @ hand_pose(np.array((AHEAD, sign * width / 2, HEIGHT)), down, across)
                for side, sign in zip(SIDES, (1.0, -1.0), strict=True)}

    def _width(self) -> float:
        return float(np.linalg.norm(hand_now(self, "left")[:3, 3] - hand_now(self, "right")[:3, 3]))

    def _tension(self) -> float:
        """How hard the cloth pulls the hands together, of both hands the lesser [N]."""
        forces = self.world.observe().wrench_hand_in_map[:, :3]
        across = hand_now(self, "right")[:3, 3] - hand_now(self, "left")[:3, 3]
        across /= np.linalg.norm(across)
        return float(min(forces[0] @ across, -forces[1] @ across))

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        return cls("draw taut", context)

"""Stage A: the hand that holds one corner of the neckline draws it aside and up, which opens the fold of the other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.estimates import GraspPoint
from ..sim.robot.kinematics import planar_pose
from ..sim.world import Side
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .motion.errors import MotionError

BELOW, RISE = -0.10, 0.16  # where the hand is weighed on its way, and where it ends, above the hook [m]
AWAY = float(np.deg2rad(30.0))  # from sideways to the far side of the rail: the other half turns to the robot [rad]
ENOUGH = 2.8  # of a gown that weighs 4.0 to 4.8 N: an open hook lets go of cloth that hardly pulls [N]
SHARES = (1.0, 0.75, 0.5)  # of that, as far as the arm reaches
SLACK = 0.95  # of the corner's distance from the hook is used: the hook may not pull at the hand


class RaiseCorner(Skill):
    """Carries a corner to the side and above the hook, the neckline all but straight, unless it grows too heavy before.

    Inputs: `hand` that holds it; `hook`; `away`, how far behind the rail [rad]; `weight` that it must carry in the end
    [N]; `heavy`, more than one corner weighs before it is above the hook: then folds behind it were taken too [N].
    Outputs: `held`, the length of the neckline from the hook to the hand [m].
    """

    hand = Input(Side)
    hook = Input(GraspPoint)
    away = Input(float, default=AWAY)
    weight = Input(float, default=0.8)
    heavy = Input(float, default=2.6)
    held = Output(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED, Reason.MULTI_LAYER)

    def steps(self) -> Iterator[None]:
        """Draw, weigh."""
        self.note("draws the corner aside")
        base = planar_pose(self.world.observe().pose_base_in_map)[:3, :3]
        pose = hand_now(self, self.hand)
        hook = self.hook.position_in_map
        length = float(np.linalg.norm(pose[:3, 3] - hook))
        sideways = base[:, 1] if self.hand == "left" else -base[:, 1]
        hangs, carried = bool(pose[2, 3] < hook[2]), 0.0
        for rise in (BELOW, RISE) if hangs else (RISE,):
            level = np.sqrt(max(((SLACK if hangs else 1.0) * length) ** 2 - rise**2, 0.01))
            for share in SHARES:
                angle = share * self.away
                aside = np.cos(angle) * sideways + np.sin(angle) * base[:, 0]
                pose[:3, 3] = hook + level * aside + rise * base[:, 2]
                try:
                    yield from self._carry(pose)
                    break
                except MotionError:  # behind the rail the arm soon ends
                    if share == SHARES[-1]:
                        raise
            yield from self.wait(1.0 if rise > 0.0 else 0.2)  # the gown swings out
            carried = -float(cloth_load(self, self.hand)[2])
            if rise < 0.0 and carried > self.heavy:
                raise SkillFailure(Reason.MULTI_LAYER, f"the {self.hand} hand carries {carried:.1f} N below the hook")
            self.note(f"draws the corner aside, {carried:.1f} N")
        if carried < self.weight:
            raise SkillFailure(Reason.GRASP_MISSED, f"the {self.hand} hand carries {carried:.1f} N")
        self.held = length

    def _carry(self, pose: np.ndarray) -> Iterator[None]:
        """To a pose (4, 4), or until the hand carries so much that the rest hardly holds the gown on its hook."""
        for _ in move_hands(self, {self.hand: pose}, speed=0.3, free="any", way="either"):
            if -cloth_load(self, self.hand)[2] > ENOUGH:
                self.world.stop()
                break
            yield

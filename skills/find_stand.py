"""Stage C: where to stand so that one hand lifts the arm and the other one takes the sleeve where it lies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import ArmPosture, SleeveOpening
from ..sim.robot import model
from ..sim.robot.kinematics import default_kinematics
from ..sim.world import SIDES, Side
from .belief.person_tracking import watch_arm
from .belief.sleeve_search import find_sleeve, strap_position, strap_views
from .control.arm_grip import over_arm
from .control.hands import collision_checker
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.stances import HEADWARD, outwards, stance
from .lift_arm import ABOVE, PITCH, SPREAD, lifted
from .motion.errors import Unreachable
from .motion.ik import hand_pose, solve_ik
from .motion.path import is_free
from .motion.trajectory import free_postures

# Steps off the usual stance that are tried, farther from the bed and towards its head [m].
_OUT, _HEADWARD = (0.0, 0.08, 0.16, 0.24, -0.08), (0.0, 0.1, -0.1, 0.2, -0.2, 0.3)
_TILT = np.deg2rad(60.0)  # of a grasp below the horizontal
_STRAP_ABOVE = 0.08  # a hand that waits over the strap [m]


class FindStand(Skill):
    """The usual stance where that will do, else the nearest one from which both hands reach what they are for.

    Where the sleeve is not seen, it is the usual stance.

    Inputs: `side` of the person; `lifting` and `pulling` hand.  Output: `stand`, base pose (3,) [m, m, rad].
    """

    commands = False
    side = Input(Side)
    lifting = Input(Side)
    pulling = Input(Side)
    stand = Output(np.ndarray)
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """Look once, then try stances."""
        posture = watch_arm(self, self.side)
        usual = self.stand = stance(self.side, "lift")
        try:
            sleeve = find_sleeve(self, self.side, posture.points_in_map)
        except PerceptionFailure:
            return
        steps = [out * outwards(self.side) + head * HEADWARD for out in _OUT for head in _HEADWARD]
        for step in sorted(steps, key=lambda step: float(np.linalg.norm(step))):
            base = usual + (step[0], step[1], 0.0)
            if is_free(self.world.room, base[:2]) and self._reaches(base, posture, sleeve):
                self.stand = base
                return
            yield

    def _reaches(self, base: np.ndarray, posture: ArmPosture, sleeve: SleeveOpening) -> bool:
        """Whether from `base` (3,) one hand lifts the arm, and the other one then looks at the strap and takes it."""
        arms = model.READY.copy()
        bed = self.world.room.bed
        shoulder, elbow = posture.points_in_map[:2]
        end = over_arm(posture, 1.0, lift=0.0)
        end[:3, 3] = shoulder + np.linalg.norm(elbow - shoulder) * lifted(posture, self.side, 1.0, PITCH, SPREAD)
        lifts = [over_arm(posture, 1.0, lift=ABOVE), end]
        views = strap_views(sleeve, self.side, self.pulling, bed)
        approach = -np.cos(_TILT) * outwards(self.side) - np.sin(_TILT) * UP
        strap = strap_position(sleeve) - _STRAP_ABOVE * approach
        grasps = [hand_pose(strap, approach, turn * sleeve.closing_in_map) for turn in (1.0, -1.0)]
        for pose in lifts:
            q = self._posture(self.lifting, [pose, pose @ np.diag((-1.0, -1.0, 1.0, 1.0))], base, arms)
            if q is None:
                return False
            arms[SIDES.index(self.lifting)] = q
        return all(self._posture(self.pulling, poses, base, arms) is not None for poses in (views, grasps))

    def _posture(
        self, hand: Side, poses: Iterable[np.ndarray], base: np.ndarray, arms: np.ndarray
    ) -> np.ndarray | None:
        """Joint angles (7,) for the first of `poses` that is within reach without touching anything."""
        free = free_postures(collision_checker(self), hand, base, arms)
        for pose in poses:
            try:
                return solve_ik(default_kinematics(), hand, pose, base, arms[SIDES.index(hand)], seeds=6, accept=free)
            except Unreachable:
                continue
        return None

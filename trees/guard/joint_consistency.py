"""Whether what is said of the joints can be: each within its limits, and the hands where the joints put them.

A driver that mixes up joints, counts in degrees or millimetres, or whose joint state stands still while its hands
move, leaves the guard with links that are elsewhere.
"""

from __future__ import annotations

import numpy as np

from ...sim.abilities import HandKinematics
from ...sim.mechanics.kinematics import Kinematics
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import SIDES, Observation

BEYOND = 0.1  # [rad] of a limit that a joint may be measured: choice, an arm that is pressed against its stop
ASIDE = 0.1  # [m] from where the joints put it that a hand may be told: choice, a base that drives on meanwhile


class JointConsistency:
    """Judges each sample once.

    Args:
        robot: what it is made of.
        kinematics: of the world, or of its robot's model.
    """

    def __init__(self, robot: RobotModel, kinematics: HandKinematics) -> None:
        self._robot, self._kinematics = robot, kinematics
        self._lower = self._upper = None
        if isinstance(kinematics, Kinematics):
            limits = [kinematics.limits[side] for side in SIDES]
            self._lower = np.array([each.lower for each in limits]) - BEYOND
            self._upper = np.array([each.upper for each in limits]) + BEYOND
        self._judged: float | None = None  # time of the sample [s]

    def fault(self, seen: Observation) -> str:
        """What cannot be, one clause; empty where all can."""
        if seen.time == self._judged:
            return ""
        if self._lower is not None and self._upper is not None:
            beyond = (seen.arm_positions < self._lower) | (seen.arm_positions > self._upper)
            if beyond.any():
                n, k = np.argwhere(beyond)[0]
                low, high = self._lower[n, k] + BEYOND, self._upper[n, k] - BEYOND
                name = self._robot.joints_of(SIDES[n])[k]
                at = seen.arm_positions[n, k]
                return f"{name} is said to be at {at:.2f} rad, but it turns from {low:.2f} to {high:.2f}"
        for n, side in enumerate(SIDES):
            place = self._kinematics.pose_hand_in_map(side, seen.arm_positions[n], seen.pose_base_in_map)[:3, 3]
            away = float(np.linalg.norm(seen.pose_hand_in_map[n, :3, 3] - place))
            if away > ASIDE:
                return f"the {side} hand is said to be {away:.2f} m from where its joints put it"
        self._judged = seen.time
        return ""

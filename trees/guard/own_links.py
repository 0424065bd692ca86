"""Keeps the robot's links off each other: a planner does so for one motion, nobody for hands that velocities drive."""

from __future__ import annotations

import numpy as np

from ...sim.mechanics.collision import CollisionChecker
from ...sim.mechanics.kinematics import Kinematics
from ...sim.segments import capsule_gaps
from ...sim.world import JointTrajectory, Observation
from ...skills.core.reasons import Reason, SkillFailure
from .link_motion import LinkMotion

LEAST = 0.01  # [m] between links, as where a way is planned (`CollisionChecker`)
CHECKED = 60  # postures of a trajectory that are tested, about
FAR = 10.0  # [m] the gap of two links that cannot touch; finite, as differences are taken


class OwnLinks:
    """The gaps among the links of a robot that could touch each other (`RobotModel.own_pairs`).

    Args:
        motion: where commands bring the links.
        kinematics: of the robot.
    """

    def __init__(self, motion: LinkMotion, kinematics: Kinematics) -> None:
        self._motion = motion
        robot = kinematics.robot
        pairs = {frozenset(pair) for pair in robot.own_pairs}
        links = [capsule.link for capsule in robot.capsules]
        self._could_touch = np.array([[frozenset((a, b)) in pairs for b in links] for a in links])
        self._checker = CollisionChecker(kinematics, margin=0.0)

    def room(self, ends: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What is left of the gaps between some links and all.

        Args:
            ends: (r, 2, 3) of their axes [m].
            rows: (r,) bool, of k of them.

        Returns:
            (k, r) what is left of the gap between two links, below 0 where they are too near [m], and (k, r, 3)
            directions from the second to the first.
        """
        radii = self._motion.radii
        gaps, away = capsule_gaps(ends[rows], radii[rows], ends, radii)
        return np.where(self._could_touch[rows], gaps - LEAST, FAR), away

    def judge(self, trajectory: JointTrajectory, seen: Observation) -> None:
        """Refuse a trajectory on which links touch that do not touch now.

        Raises:
            SkillFailure: MOTION_BLOCKED, which names both.
        """
        base, pan = seen.pose_base_in_map, seen.head_pan
        now = set(self._checker.collisions(base, seen.arm_positions, pan))
        _, postures = self._motion.postures(trajectory, seen)
        chosen = np.append(np.arange(0, len(postures), max(1, len(postures) // CHECKED)), len(postures) - 1)
        for hits in self._checker.collisions_along(base, postures[chosen], pan):
            if touching := [pair for pair in hits if pair not in now]:
                one, other = (name.replace("_", " ") for name in touching[0])
                raise SkillFailure(Reason.MOTION_BLOCKED, f"the {one} would touch the {other}")

"""Choose where to stand so that one hand lifts the arm and the other one takes the sleeve where it lies."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import ArmPosture, SleeveOpening
from ..sim.mechanics.kinematics import kinematics_of
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Side
from .belief.person_tracking import watch_arm
from .belief.refused_stands import refused_stands
from .belief.sleeve_search import find_sleeve, strap_position, strap_views
from .control.arm_grip import over_arm
from .control.hands import collision_checker
from .core.ports import Input, Output
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP, ArmPath
from .geometry.stances import HEADWARD, outwards, stance
from .lift_arm import LiftGoal, goal_for, lifted
from .motion.errors import Unreachable
from .motion.ik import half_turned, hand_pose, solve_ik
from .motion.path import is_free
from .motion.trajectory import free_postures


@dataclass(frozen=True, kw_only=True)
class FindStandTuning(Quantities):
    """Which stances are tried, and what the hands have to reach from there."""

    steps_outwards: tuple[float, float, float, float, float] = quantity(
        (0.0, 0.08, 0.16, 0.24, -0.08), "m", "from the usual stance, away from the bed", "choice: a hand's width each"
    )
    steps_headward: tuple[float, float, float, float, float, float] = quantity(
        (0.0, 0.1, -0.1, 0.2, -0.2, 0.3), "m", "from the usual stance, towards the bed's head", "choice: 10 cm each"
    )
    grasp_tilt: float = quantity(
        float(np.deg2rad(60.0)), "rad", "of the strap's grasp below the horizontal", "choice: between flat and steep"
    )
    grasp_height: float = quantity(0.08, "m", "of a hand that waits before the strap", "choice: clear of the cloth")
    ik_seeds: int = quantity(
        6, "1", "postures from which the solution is looked for", "choice: more take longer, for each of many stances"
    )
    elsewhere: float = quantity(
        0.06,
        "m",
        "from where the sleeve was out of reach before, at least",
        "measured: from one stand the strap had no free posture six times of six (153)",
    )
    lift: LiftGoal = field(default_factory=LiftGoal)


class FindStand(Skill):
    """The usual stance where that will do, else the nearest one from which both hands reach what they are for.

    One from which the sleeve turned out to be out of reach will not do again.  Where the sleeve is not seen, it is the
    usual stance; it fails where the arm is not known.
    """

    commands = False
    side = Input(Side, doc="arm of the person")
    lifting = Input(Side, doc="hand that will lift the arm")
    pulling = Input(Side, doc="hand that will take the sleeve")
    stand = Output(np.ndarray, unit="m, m, rad, map", doc="base pose (3,)")
    tuning = Input(FindStandTuning, default=FindStandTuning(), doc="numbers of this skill")
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """Look once, then try stances."""
        posture = watch_arm(self, self.side)
        usual = self.stand = stance(self.side, "lift")
        try:
            sleeve = find_sleeve(self, self.side, posture.points_in_map)
        except PerceptionFailure:
            return
        steps = [
            out * outwards(self.side) + head * HEADWARD
            for out in self.tuning.steps_outwards
            for head in self.tuning.steps_headward
        ]
        for step in sorted(steps, key=lambda step: float(np.linalg.norm(step))):
            base = usual + (step[0], step[1], 0.0)
            if self._was_refused(base) or not is_free(self.world.room, base[:2]):
                continue
            if self._reaches(base, posture, sleeve):
                self.stand = base
                return
            yield

    def _was_refused(self, base: np.ndarray) -> bool:
        refused = refused_stands(self, self.side)
        return any(np.linalg.norm(base[:2] - there[:2]) < self.tuning.elsewhere for there in refused)

    def _reaches(self, base: np.ndarray, posture: ArmPosture, sleeve: SleeveOpening) -> bool:
        """Whether from `base` (3,) one hand lifts the arm, and the other one then looks at the strap and takes it."""
        arms = self.world.robot.ready.copy()
        bed = self.world.room.bed
        tuning, lift = self.tuning, goal_for(self, self.side, posture, self.tuning.lift)
        shoulder, held = posture.points_in_map[0], ArmPath.of(posture).point(lift.grip_coordinate)
        up = lifted(posture, self.side, lift)
        end = over_arm(posture, lift.grip_coordinate, lift=0.0)
        end[:3, 3] = shoulder + np.linalg.norm(held - shoulder) * up
        lifts = [over_arm(posture, lift.grip_coordinate, lift=lift.approach_height), end]
        views = strap_views(self.world.robot, sleeve, self.side, self.pulling, bed)
        approach = -math.cos(tuning.grasp_tilt) * outwards(self.side) - math.sin(tuning.grasp_tilt) * UP
        strap = strap_position(sleeve) - tuning.grasp_height * approach
        grasps = [hand_pose(strap, approach, turn * sleeve.closing_in_map) for turn in (1.0, -1.0)]
        for pose in lifts:
            q = self._posture(self.lifting, [pose, half_turned(pose)], base, arms)
            if q is None:
                return False
            arms[SIDES.index(self.lifting)] = q
        return all(self._posture(self.pulling, poses, base, arms) is not None for poses in (views, grasps))

    def _posture(
        self, hand: Side, poses: Iterable[np.ndarray], base: np.ndarray, arms: np.ndarray
    ) -> np.ndarray | None:
        """Joint angles (n,) for the first of `poses` that is within reach without touching anything."""
        free = free_postures(collision_checker(self), hand, base, arms)
        kinematics, start, seeds = kinematics_of(self.world.robot), arms[SIDES.index(hand)], self.tuning.ik_seeds
        for pose in poses:
            with suppress(Unreachable):
                return solve_ik(kinematics, hand, pose, base, start, seeds=seeds, accept=free)
        return None

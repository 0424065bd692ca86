"""Draw the corner of the neckline that a hand holds aside and up, which opens the fold that hides the other corner."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.estimates import GraspPoint
from ..sim.mechanics.planar import planar_pose
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .control.hands import cloth_load, hand_now, move_hands
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class RaiseCornerTuning(Quantities):
    """Numbers of `RaiseCorner`."""

    weighing_height: float = quantity(
        -0.10,
        "m",
        "above the hook, at which the corner is weighed on its way",
        "choice: the hook still carries the rest",
    )
    final_height: float = quantity(
        0.16, "m", "above the hook, to which the corner is raised", "choice: the fold of the other corner opens"
    )
    stretch: float = quantity(
        0.95,
        "1",
        "share of the corner's distance from the hook that is kept while it hangs below the hook",
        "choice: the hook must not pull at the hand",
    )
    min_distance: float = quantity(
        0.1, "m", "from the hook to the hand, horizontally", "choice: keeps the way defined for a short neckline"
    )
    angle_shares: tuple[float, float, float] = quantity(
        (1.0, 0.75, 0.5), "1", "shares of `angle` that are tried in turn", "choice: the arm soon ends behind the rail"
    )
    unhooking_load: float = quantity(
        2.8,
        "N",
        "on the hand, at which it goes no farther",
        "choice: of a gown that weighs 4.0 to 4.8 N; an open hook lets go of cloth that hardly pulls at it",
    )
    speed: float = quantity(0.3, "m/s", "of the hand", "choice: the cloth follows without swinging far")
    weighing_time: float = quantity(
        0.2, "s", "of rest before the corner is weighed below the hook", "choice: it has come up slowly"
    )
    swing_time: float = quantity(1.0, "s", "of rest above the hook", "choice: the gown swings out")


class RaiseCorner(Skill):
    """Carries a corner to the side and above the hook, along an arc on which the neckline is all but straight.

    A gown on one hook rolls itself up, its corners before it.  So the corner goes sideways first, which unrolls it, and
    then behind the rail: straight there it would turn its half of the gown round the sleeve, whose back panel would
    lie below the front when the gown is laid (docs/dressing-findings.md).
    The hand stops early where it carries so much that the hook might lose the gown.  It fails where the corner weighs
    too much below the hook (folds behind it were taken too) or too little in the end (the corner was lost).
    """

    hand = Input(Side, doc="the hand that holds the corner")
    hook = Input(GraspPoint, unit="m, map", doc="where the gown hangs")
    angle = Input(
        float,
        unit="rad",
        doc="by which the corner goes from sideways to behind the rail in the end; the other half of the gown turns "
        "to the robot",
        default=float(np.deg2rad(30.0)),
    )
    min_load = Input(float, unit="N", doc="least load that the hand must carry in the end", default=0.8)
    max_load = Input(float, unit="N", doc="greatest load of one corner while it is below the hook", default=2.6)
    tuning = Input(RaiseCornerTuning, default=RaiseCornerTuning(), doc="numbers of this skill")
    held_length = Output(float, unit="m", doc="of the neckline from the hook to the hand")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.GRASP_MISSED, Reason.MULTI_LAYER)

    def steps(self) -> Iterator[None]:
        """Draw, weigh."""
        tuning = self.tuning
        self.note("draws the corner aside")
        base = planar_pose(self.world.observe().pose_base_in_map)[:3, :3]
        pose = hand_now(self, self.hand)
        hook = self.hook.position_in_map
        length = float(np.linalg.norm(pose[:3, 3] - hook))
        sideways = base[:, 1] if self.hand == "left" else -base[:, 1]
        hangs, carried = bool(pose[2, 3] < hook[2]), 0.0
        for rise in (tuning.weighing_height, tuning.final_height) if hangs else (tuning.final_height,):
            level = np.sqrt(max(((tuning.stretch if hangs else 1.0) * length) ** 2 - rise**2, 0.0))
            level = max(level, tuning.min_distance)
            tries = Tries(MotionError)
            for share in tuning.angle_shares:
                angle = share * self.angle if rise > 0.0 else 0.0
                aside = math.cos(angle) * sideways + math.sin(angle) * base[:, 0]
                pose[:3, 3] = hook + level * aside + rise * base[:, 2]
                with tries:
                    yield from self._carry(pose)
                    break
            else:
                raise tries.last
            yield from self.wait(tuning.swing_time if rise > 0.0 else tuning.weighing_time)
            carried = -float(cloth_load(self, self.hand)[2])
            if rise < 0.0 and carried > self.max_load:
                raise SkillFailure(Reason.MULTI_LAYER, f"the {self.hand} hand carries {carried:.1f} N below the hook")
            self.note(f"draws the corner aside, {carried:.1f} N")
        if carried < self.min_load:
            raise SkillFailure(Reason.GRASP_MISSED, f"the {self.hand} hand carries {carried:.1f} N")
        self.held_length = length

    def _carry(self, pose: np.ndarray) -> Iterator[None]:
        """To a pose (4, 4), or until the hand carries so much that the rest hardly holds the gown on its hook."""
        for _ in move_hands(self, {self.hand: pose}, speed=self.tuning.speed, free="any", way="either"):
            if -cloth_load(self, self.hand)[2] > self.tuning.unhooking_load:
                self.world.stop()
                break
            yield

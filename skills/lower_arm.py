"""Put an arm down that is up and that no hand holds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..perception.estimates import ArmPosture
from ..perception.person.arm_fit import turned_about_shoulder
from ..sim.quantity import Quantities, quantity
from ..sim.world import SensorLost, Side
from .belief.person_tracking import watch_arm
from .control.arm_grip import over_arm, top_down_reachable
from .control.let_arm_go import LetArmGoTuning, let_arm_go
from .control.lowering import LoweringTuning, lies, lower_arm, resting_place
from .control.ready import Ready
from .control.take_arm import TakeArmTuning, take_arm
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.hold import Hold
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LowerArmTuning(Quantities):
    """Which arms are lowered, and where they are taken."""

    lies_below: float = quantity(
        0.14,
        "m",
        "height of elbow, wrist and fingertip above the mattress, below which an arm is left as it lies",
        "choice: a hand's breadth more than where lowering ends, and below the 0.20 m that a wrist may be at",
    )
    grips: tuple[float, float, float] = quantity(
        (1.25, 1.5, 1.0),
        "1",
        "arm coordinates of the grip, tried one after the other: 1 elbow, 2 wrist",
        "choice: bare, below the sleeve, and near the elbow, which carries forearm and upper arm",
    )
    take: TakeArmTuning = field(default_factory=TakeArmTuning)
    lowering: LoweringTuning = field(default_factory=LoweringTuning)
    leaving: LetArmGoTuning = field(default_factory=LetArmGoTuning)


class LowerArm(Skill):
    """Looks at an arm; where it does not lie, takes it by the bare forearm, swings it down and lets it go.

    An arm that stays up by itself may be let go of anywhere: so the hand holds nothing in the end, and after most
    failures.  It fails where the arm is not seen or out of reach, where the fingers close on nothing or lose the arm,
    and where it does not come down.
    """

    side = Input(Side, doc="arm of the person")
    hand = Input(Side, doc="hand of the robot that takes it")
    ready = Input(Ready, default="if possible", doc="whether the hand then goes to its ready posture")
    tuning = Input(LowerArmTuning, default=LowerArmTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.ARM_SLIPPED,
        Reason.FORCE_LIMIT,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look; take it, swing it down, let go, look again."""
        posture = watch_arm(self, self.side, period=0.0)
        if lies(self, posture, self.tuning.lies_below):
            self.note(f"sees that the {self.side} arm lies")
            return
        self.note(f"takes the {self.side} arm")
        coordinate, on_arm = self._grip(posture)
        yield from take_arm(self, self.hand, on_arm, tuning=self.tuning.take)
        held = self.side, Hold(self.hand, coordinate)
        self.note(f"lowers the {self.side} arm")
        try:
            yield from lower_arm(self, self.hand, held, tuning=self.tuning.lowering)
        except (SkillFailure, SensorLost):
            yield from let_arm_go(self, self.hand, "never", tuning=self.tuning.leaving)
            raise
        yield from let_arm_go(self, self.hand, self.ready, tuning=self.tuning.leaving)
        posture = watch_arm(self, self.side, period=0.0)
        if not lies(self, posture, self.tuning.lies_below):
            height = posture.points_in_map[1:, 2].max() - self.world.room.bed[1, 2]
            raise SkillFailure(Reason.ARM_SLIPPED, f"its highest joint is {height:.2f} m above the mattress")

    def _grip(self, posture: ArmPosture) -> tuple[float, np.ndarray]:
        """Arm coordinate of the grip, and the pose (4, 4) of the hand there.

        Raises:
            MotionError: no grip is within reach from above the arm to where it comes to rest.
        """
        tuning, tries = self.tuning, Tries(MotionError)
        for coordinate in tuning.grips:
            with tries:
                rest = resting_place(self, self.side, posture, coordinate, tuning=tuning.lowering)
                points = turned_about_shoulder(posture.points_in_map, coordinate, rest)
                lying = over_arm(replace(posture, points_in_map=points), coordinate, lift=0.0)
                top_down_reachable(self, self.hand, lying, clear=False)
                on_arm = over_arm(posture, coordinate, lift=0.0)
                ways = -tuning.take.approach_height * on_arm[:3, 2], np.zeros(3)
                return coordinate, top_down_reachable(self, self.hand, on_arm, ways)
        raise tries.last

"""Take the seam over a shoulder of a gown that the person wears, from beside the bed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ....perception.estimates import GraspPoint
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.control.base import BaseTuning, stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import open_gripper
from ....skills.control.hands import cloth_load, hand_now
from ....skills.control.head import look_towards
from ....skills.control.pinch import back_off
from ....skills.control.take_from_above import FromAbove, take_from_above
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.core.tries import Tries
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import outwards
from ....skills.motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class TakeSeamTuning(Quantities):
    """Numbers of `TakeSeam`."""

    stand: BaseTuning = field(default_factory=lambda: BaseTuning(ease=(0.82, 0.22)))
    # as deep as where the seam is drawn up: the mattress is 6 cm below
    grasp: FromAbove = field(default_factory=lambda: FromAbove(depth=0.02))
    leans: tuple[float, ...] = quantity(
        (0.2, 0.45, 0.0), "rad", "of the hand towards the robot, off the vertical, tried in turn", "choice: any will do"
    )
    lift: float = quantity(0.12, "m", "by which it is lifted to be felt", "choice: clear of shoulder and arm")
    min_load: float = quantity(0.3, "N", "of a sleeve at that height", "measured: 0.5 N (100); a tenth of the gown")
    carry: Carry = field(default_factory=lambda: Carry(speed=0.10, max_load=9.0))


class TakeSeam(Skill):
    """Looks for the seam over the shoulder, stands near it, takes it from above, lifts it a little and weighs it.

    Where nothing hangs on the hand, the fingers open and the hand draws back.
    """

    side = Input(Side, doc="of the person")
    hand = Input(Side, doc="hand of the robot")
    tuning = Input(TakeSeamTuning, default=TakeSeamTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.ARM_LOST,
        Reason.PATH_BLOCKED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.GRASP_MISSED,
        Reason.TIMEOUT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Look, stand, reach in, close, lift, weigh."""
        tuning = self.tuning
        self.note(f"looks for the seam over the {self.side} shoulder")
        shoulder = watch_arm(self, self.side).points_in_map[0]
        yield from look_towards(self, shoulder)
        facing = shoulder * (-1.0, 1.0, 1.0)  # tells which way is outwards; the other shoulder may be covered
        shoulders = np.array([shoulder if side == self.side else facing for side in SIDES])
        seam = self.context.senses.shoulder_seam(self.world.look("head"), side=self.side, shoulders_in_map=shoulders)
        self.note(f"takes the seam over the {self.side} shoulder")
        yield from stand_for(self, self.hand, seam.position_in_map, tuning=tuning.stand)
        yield from self._take(seam)
        here = hand_now(self, self.hand)[:3, 3]
        yield from carry(self, self.hand, here + tuning.lift * UP, tuning.carry)
        load = float(np.linalg.norm(cloth_load(self, self.hand)))
        if load < tuning.min_load:
            yield from open_gripper(self, self.hand)
            yield from back_off(self, self.hand)
            raise SkillFailure(Reason.GRASP_MISSED, f"{load:.1f} N hang on the {self.hand} hand")

    def _take(self, seam: GraspPoint) -> Iterator[None]:
        """Leaning towards the robot as far as the arm reaches it that way."""
        outward, tries = outwards(self.side), Tries(MotionError)
        for lean in self.tuning.leans:
            leaning = replace(seam, approach_in_map=-math.cos(lean) * UP - math.sin(lean) * outward)
            with tries:
                yield from take_from_above(self, self.hand, leaning, outward, self.tuning.grasp)
                return
        raise tries.last

"""Take the edge of a blanket that lies on the person, and feel whether it is held."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field

import numpy as np

from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.control.base import BaseTuning, stand_for
from ....skills.control.carry import Carry, carry
from ....skills.control.fingers import close_gripper, open_gripper
from ....skills.control.hands import cloth_load, hand_now
from ....skills.control.head import pan_head
from ....skills.control.pinch import back_off, reach_in
from ....skills.core.ports import Input, Output
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill
from ....skills.core.tries import Tries
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import outwards
from ....skills.motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class TakeEdgeTuning(Quantities):
    """Numbers of `TakeEdge`."""

    stand: BaseTuning = field(default_factory=lambda: BaseTuning(ease=(0.82, 0.22)))
    leans: tuple[float, ...] = quantity(
        (0.2, 0.45, 0.0), "rad", "of the hand towards the robot, off the vertical, tried in turn", "choice: any will do"
    )
    insets: tuple[float, ...] = quantity(
        (0.02, 0.06, 0.12, 0.18),
        "m",
        "of the grasp from the edge into the cloth, tried in turn",
        "choice: beside the person's arm there is no way",
    )
    depth: float = quantity(
        0.010, "m", "of the fingertips beyond the cloth", "choice: it slopes down there, and there is room below it"
    )
    speed: float = quantity(0.12, "m/s", "of the hand", "choice: slow beside the person")
    lift: float = quantity(0.10, "m", "by which it is lifted to be felt", "choice: clear of what it lies on")
    min_load: float = quantity(0.4, "N", "of a blanket's edge at that height", "choice: a tenth of its weight")
    carry: Carry = field(default_factory=lambda: Carry(speed=0.10, max_load=15.0))


class TakeEdge(Skill):
    """Stands near, takes the edge that lies nearest to the head from above, lifts it a little and weighs it.

    The camera of a hand that comes from above cannot see what its fingers hold: the cloth is in between.  Where nothing
    hangs on it the fingers open, and the hand draws back.
    """

    side = Input(Side, doc="of the bed, the person's own left or right")
    hand = Input(Side, doc="hand of the robot")
    inset = Output(float, unit="m", doc="of the grasp from the edge into the cloth")
    tuning = Input(TakeEdgeTuning, default=TakeEdgeTuning(), doc="numbers of this skill")
    reasons = (
        Reason.NOTHING_SEEN,
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
        self.note("looks for the blanket's edge")
        yield from pan_head(self, 0.0)
        edge = self.context.senses.hang_point(self.world.look("head"))
        self.note("takes the blanket's edge")
        yield from stand_for(self, self.hand, edge.position_in_map, tuning=tuning.stand)
        self.inset = yield from self._reach(edge.position_in_map, edge.closing_in_map)
        yield from close_gripper(self, self.hand)
        self.context.guard.declare_grip(self.hand, "cloth")
        here = hand_now(self, self.hand)[:3, 3]
        yield from carry(self, self.hand, here + tuning.lift * UP, tuning.carry)
        load = -float(cloth_load(self, self.hand) @ UP)
        if load < tuning.min_load:
            yield from open_gripper(self, self.hand)
            yield from back_off(self, self.hand)
            raise SkillFailure(Reason.GRASP_MISSED, f"{load:.1f} N hang on the {self.hand} hand")

    def _reach(self, edge: np.ndarray, closing: np.ndarray) -> Generator[None, None, float]:
        """Around the edge (3,), or as near to it as the arm gets; how far from it [m]."""
        tuning, tries = self.tuning, Tries(MotionError)
        for inset in tuning.insets:
            for lean in tuning.leans:
                approach = -math.cos(lean) * UP - math.sin(lean) * outwards(self.side)
                place = edge + (0.0, inset, 0.0)
                with tries:
                    yield from reach_in(
                        self, self.hand, place, approach, closing, depth=tuning.depth, speed=tuning.speed
                    )
                    return inset
        raise tries.last

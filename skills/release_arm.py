"""Let a held arm go: lower it first or leave it where the gown carries it, open, and draw the hand away."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.robot import model
from ..sim.world import SIDES, HandTwist, Side
from .belief.person_tracking import careful
from .control.arm_grip import lost_arm
from .control.compliant_hold import COMPLIANT_HOLD, compliant_velocity
from .control.fingers import open_gripper
from .control.hands import move_arms
from .control.ready import Ready, ready_or_not
from .control.withdraw import WithdrawTuning, withdraw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP


@dataclass(frozen=True, kw_only=True)
class ReleaseArmTuning(Quantities):
    """Numbers of lowering an arm and of letting it go."""

    lowering_speed: float = quantity(0.04, "m/s", "of the hand on its way down", "choice: gentle on the shoulder")
    rest_load: float = quantity(
        4.0,
        "N",
        "vertical load below which the bed carries the arm",
        "choice: until then the arm hangs on the hand with several newtons",
    )
    load_delay: float = quantity(
        1.0, "s", "from the start, before that load counts", "choice: by then the hand is on its way down"
    )
    max_lowering: float = quantity(
        0.35, "m", "by which an arm is lowered at most", "choice: more than a lifted arm comes down"
    )
    bed_clearance: float = quantity(
        0.05, "m", "of the hand above the mattress at the lowest", "choice: the arm's own thickness lies between"
    )
    time_allowance: float = quantity(
        2.0, "1", "greatest time for the way down, in times of `max_lowering` at full speed", "choice: room to yield"
    )
    withdraw_distance: float = quantity(
        0.16, "m", "by which the open hand draws back before it goes anywhere else", "choice: clear of the arm"
    )
    withdraw: WithdrawTuning = field(default_factory=WithdrawTuning)
    ready_speed: float = quantity(
        0.5, "m/s", "of the hand on its way to the ready posture, away from the person", "choice: quick in the open"
    )


class ReleaseArm(Skill):
    """Ends a hold of the person's arm, whatever state it is in; a hand that holds nothing just opens and withdraws.

    It fails where a command is lost, or where no way to the ready posture is found.
    """

    hand = Input(Side, doc="hand of the robot that holds the arm")
    lower = Input(bool, default=False, doc="whether the arm is lowered onto the bed first")
    ready = Input(Ready, default="never", doc="whether the hand then goes to its ready posture")
    tuning = Input(ReleaseArmTuning, default=ReleaseArmTuning(), doc="numbers of this skill")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Lower if asked to, open, up and away."""
        yield from ready_or_not(self, self.ready, self._let_go)

    def _let_go(self, ready: bool) -> Iterator[None]:
        if self.lower and not lost_arm(self, self.hand):
            self.note("lowers the arm")
            yield from self._lower()
        self.note("lets the arm go")
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], self.tuning.withdraw_distance, self.tuning.withdraw)
        if ready:
            speed = careful(self, self.tuning.ready_speed)
            yield from move_arms(self, model.READY, sides=(self.hand,), speed=speed, retreat=True)

    def _lower(self) -> Iterator[None]:
        """Go straight down until the bed carries the arm."""
        n, tuning = SIDES.index(self.hand), self.tuning
        start, begin = self.world.observe(), self.now()
        floor = max(
            start.pose_hand_in_map[n, 2, 3] - tuning.max_lowering, self.world.room.bed[1, 2] + tuning.bed_clearance
        )
        while self.now() - begin < tuning.time_allowance * tuning.max_lowering / tuning.lowering_speed:
            seen = self.world.observe()
            if seen.pose_hand_in_map[n, 2, 3] <= floor or lost_arm(self, self.hand):
                return
            if self.now() - begin > tuning.load_delay and -seen.wrench_hand_in_map[n, 2] < tuning.rest_load:
                return
            # the arm turns about its shoulder, so that the way down is no straight line: give way to what pulls aside
            give = compliant_velocity(seen.wrench_hand_in_map[n, :3])
            ease = float(np.clip(1.0 - np.linalg.norm(give) / COMPLIANT_HOLD.max_speed, 0.0, 1.0))
            linear = -tuning.lowering_speed * ease * UP + give
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(linear, np.zeros(3))), retreat=True)
            yield

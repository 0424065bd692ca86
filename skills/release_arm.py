"""Let a held arm go: lower it first or leave it where the gown carries it, open, and draw the hand away."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..sim.robot import model
from ..sim.world import SIDES, HandTwist, Side
from .belief.person_tracking import careful
from .control.arm_grip import lost_arm
from .control.compliant_hold import COMPLIANT_HOLD, compliant_velocity
from .control.hands import move_arms, open_gripper
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .retreat import withdraw

_SPEED = 0.04  # of lowering [m/s]
_RESTS = 4.0  # an arm that loads the hand with less than this lies on the bed [N]
_LONGEST = 0.35  # lowering never goes further than this [m]
_CLEAR = 0.16  # the open hand draws back by this before it goes anywhere else [m]


class ReleaseArm(Skill):
    """Ends a hold of the person's arm, whatever state it is in; a hand that holds nothing just opens and withdraws.

    Inputs: `hand`; `lower`, whether to bring the arm down first; `ready`, whether the hand then goes back to its
    ready posture.
    """

    hand = Input(Side)
    lower = Input(bool, default=False)
    ready = Input(bool, default=False)
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self) -> Iterator[None]:
        """Lower if asked to, open, up and away."""
        if self.lower and not lost_arm(self, self.hand):
            self.note("lowers the arm")
            yield from self._lower()
        self.note("lets the arm go")
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], _CLEAR)
        if self.ready:
            yield from move_arms(self, model.READY, sides=(self.hand,), speed=careful(self, 0.5), retreat=True)

    def _lower(self) -> Iterator[None]:
        """Go straight down until the bed carries the arm."""
        n = SIDES.index(self.hand)
        start, begin = self.world.observe(), self.now()
        floor = max(start.pose_hand_in_map[n, 2, 3] - _LONGEST, self.world.room.bed[1, 2] + 0.05)
        while self.now() - begin < 2.0 * _LONGEST / _SPEED:
            seen = self.world.observe()
            if seen.pose_hand_in_map[n, 2, 3] <= floor or lost_arm(self, self.hand):
                return
            # it hangs on the hand with several newtons until the bed takes it over
            if self.now() - begin > 1.0 and -seen.wrench_hand_in_map[n, 2] < _RESTS:
                return
            # the arm turns about its shoulder, so that the way down is no straight line: give way to what pulls aside
            give = compliant_velocity(seen.wrench_hand_in_map[n, :3])
            ease = float(np.clip(1.0 - np.linalg.norm(give) / COMPLIANT_HOLD.max_speed, 0.0, 1.0))
            linear = -_SPEED * ease * UP + give
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(linear, np.zeros(3))), retreat=True)
            yield

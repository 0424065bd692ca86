"""Look closely where the middle of the collar lies, with the hands' cameras, low from the head of the bed."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ....perception.errors import PerceptionFailure
from ....sim.quantity import Quantities, quantity
from ....sim.world import SIDES, Side
from ....skills.belief.close_look import CloseLook, close_look
from ....skills.belief.person_tracking import careful
from ....skills.belief.shoulders import between_shoulders, off_middle
from ....skills.control.hand_view import view_of
from ....skills.control.hands import move_arms, move_hands
from ....skills.control.head import look_towards
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason
from ....skills.core.skill import Skill
from ....skills.geometry.arm_path import UP
from ....skills.geometry.stances import HEADWARD, outwards
from ....skills.motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LookAtCollarTuning(Quantities):
    """From where both hands look."""

    eyes: tuple[tuple[float, float, float], ...] = quantity(
        ((0.45, 0.50, 0.25), (0.45, 0.45, 0.25), (0.45, 0.42, 0.35), (0.50, 0.35, 0.40)),
        "m",
        "of each hand's camera outwards, headward and up from the middle between the shoulders, tried in turn",
        "measured: 62 states of seeds 0, 102 to 106, 110, 148, from the first of them and the head: as one, the "
        "pictures are off by 0.032 m aside (root mean square), 0.08 m at worst; the mean of them by 0.037 m "
        "(benchmarks/collar_closely.py)",
    )
    above: float = quantity(0.06, "m", "of what they look at over that middle", "choice: the collar lies on the chest")
    speed: float = quantity(0.4, "m/s", "of the hands in the open", "choice: slow beside the person, as all motion is")
    settle_time: float = quantity(0.3, "s", "before the pictures", "choice: the hands come to rest")
    max_age: float = quantity(
        45.0,
        "s",
        "of a close look that is not taken anew, if nobody touched the gown since",
        "choice: as long as it takes to look at the sleeves meanwhile.  Looked at again, a collar 0.086 m headward was "
        "seen at 0.07 m, 0.06 m before, laid anew, and both sleeves came down (0)",
    )


class LookAtCollar(Skill):
    """Sees with all cameras where the middle of the neckline lies; what was seen since it was touched, is known.

    The head's camera looks down on a collar that hangs down the throat, and takes it for folded under.  The hands look
    along the chest, from either side of the head, each past what the other one sees; all three pictures are read as
    one.  Where the hands do not get there, looks from the head have to do.  The robot stands at the head of the bed;
    the hands end in the ready posture.
    """

    tuning = Input(LookAtCollarTuning, default=LookAtCollarTuning(), doc="numbers of this skill")
    reasons = (Reason.ARM_LOST, Reason.MOTION_BLOCKED, Reason.UNREACHABLE, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Bring the hands there, look, bring them back."""
        middle = between_shoulders(self)
        if close_look(self, self.tuning.max_age) is not None:
            yield
            return
        yield from look_towards(self, middle)
        frames = [self.world.look("head")]
        there = yield from self._go(middle)
        yield from self.wait(self.tuning.settle_time)
        frames = [self.world.look(f"{side}_hand") for side in SIDES] + frames if there else []
        yield from move_arms(self, self.world.robot.ready, speed=careful(self, self.tuning.speed))
        if not frames:
            self.note("the hands do not get to where they would see the collar")
            return
        try:
            known = self.context.senses.collar_middle(frames[0], near_in_map=middle, beside=frames[1:])
        except PerceptionFailure as failure:
            self.note(str(failure))
            return
        CloseLook.of(self).seen = known
        aside = off_middle(known.position_in_map, middle)[0]
        self.note(f"{known.confidence:.0%} of the collar shows, {aside * 100:.0f} cm aside")

    def _go(self, middle: np.ndarray) -> Generator[None, None, bool]:
        """Bring both hands to the first places that they get to, if there are any."""
        for eye in self.tuning.eyes:
            with suppress(MotionError):
                views: dict[Side, np.ndarray] = {side: self._view(side, middle, eye) for side in SIDES}
                yield from move_hands(self, views, speed=careful(self, self.tuning.speed), way="any")
                return True
        return False

    def _view(self, side: Side, middle: np.ndarray, eye: tuple[float, float, float]) -> np.ndarray:
        """Pose (4, 4) of a hand whose camera is at `eye` from the middle between the shoulders (3,) [m]."""
        aside, headward, up = eye
        place = middle + aside * outwards(side) + headward * HEADWARD + up * UP
        return view_of(self.world.robot, side, middle + self.tuning.above * UP, place)

"""Look closely where the middle of the collar lies, with the hands' cameras, low from the head of the bed."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ....perception.errors import PerceptionFailure
from ....perception.estimates import GraspPoint
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
        "measured: 16 states of seeds 176 to 178 within 0.12 m of the middle, from the first of them: off by 0.009 m "
        "aside (root mean square; 0.015 m at worst) and 0.021 m headward; from the head 0.038 and 0.033 m",
    )
    above: float = quantity(0.06, "m", "of what they look at over that middle", "choice: the collar lies on the chest")
    certain: float = quantity(
        4.0,
        "1",
        "power of how much of it a picture shows, by which that picture counts",
        "measured: 133 states of eight development seeds: off by 0.032 m aside (root mean square; 0.11 m at worst), "
        "the mean of both hands' by 0.035 and 0.15 m (benchmarks/collar_closely.py)",
    )
    apart: float = quantity(
        0.03,
        "m",
        "aside, standard deviation of where the pictures show its middle, as they count, from which any may be wrong",
        "measured: of those states 43 are told within 0.040 m of the midline, two wrongly; however far apart 4 more, "
        "one of them wrongly; by both hands' mean, no more than 0.05 m apart, 42, two wrongly",
    )
    unsure: float = quantity(
        0.75, "1", "of what shows that counts then", "choice: too little to claim, and as a rule to draw the gown over"
    )
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
    along the chest, from either side of the head, each past what the other one sees.  The more of it a picture shows,
    the more it counts.  Where not both hands get there and see it, looks from the head have to do.  The robot stands at
    the head of the bed; the hands end in the ready posture.
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
        from_head = self._looks(("head",), middle)
        there = yield from self._go(middle)
        yield from self.wait(self.tuning.settle_time)
        seen = self._looks([f"{side}_hand" for side in SIDES], middle) if there else []
        yield from move_arms(self, self.world.robot.ready, speed=careful(self, self.tuning.speed))
        if len(seen) < len(SIDES):
            self.note("not both hands see the collar")
            return
        CloseLook.of(self).seen = known = self._together([*seen, *from_head])
        told = (f"{off_middle(each.position_in_map, middle)[0] * 100:.0f}" for each in seen + from_head)
        self.note(f"{known.confidence:.0%} of the collar tells, {', '.join(told)} cm aside")

    def _together(self, seen: Sequence[GraspPoint]) -> GraspPoint:
        """What several pictures tell, the first one's stamp and direction."""
        places, shown = np.array([each.position_in_map for each in seen]), np.array([each.confidence for each in seen])
        weights = shown**self.tuning.certain
        weights /= weights.sum()
        mean = weights @ places
        apart = float(np.sqrt(weights @ (places[:, 0] - mean[0]) ** 2))
        tells = float(weights @ shown) * (self.tuning.unsure if apart > self.tuning.apart else 1.0)
        return replace(seen[0], position_in_map=mean, confidence=tells)

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

    def _looks(self, cameras: Iterable[str], middle: np.ndarray) -> list[GraspPoint]:
        """What each of some cameras sees of it, if it does."""
        looks: list[GraspPoint] = []
        for camera in cameras:
            with suppress(PerceptionFailure):
                frame = self.world.look(camera)
                looks.append(self.context.senses.collar_middle(frame, near_in_map=middle, away=(0.0, 0.0)))
        return looks

"""Once the strap is over the shoulder, draw it headward and tuck it down behind the shoulder."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, HandTwist
from .belief.person_motion import while_person_rests
from .belief.person_tracking import watch_arm
from .control.hands import cloth_load
from .control.load_easing import LoadEasing
from .control.pull_law import PullLaw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.stances import HEADWARD
from .geometry.strap_grip import StrapGrip


@dataclass(frozen=True, kw_only=True)
class SeatSleeveTuning(Quantities):
    """Numbers of drawing a strap headward and of tucking it down."""

    max_draw: float = quantity(
        0.08, "m", "by which the strap is drawn headward at most", "choice: armhole's lag behind it"
    )
    max_beyond: float = quantity(
        0.08,
        "m",
        "of the hand headward of the shoulder, where the strap is drawn no farther",
        "measured: drawn to 0.12 m and 0.17 m from both sides, the collar came over the face (seeds 103, 105)",
    )
    draw_speed: float = quantity(0.11, "m/s", "of the hand headward", "choice: below the guard's limit near the person")
    stall_time: float = quantity(
        1.6,
        "s",
        "over which the hand's way and the arm's rest are judged",
        "choice: longer than cloth sticks for a moment",
    )
    stall_record: float = quantity(
        0.9, "1", "share of that time that must be on record for a judgement", "choice: ticks do not divide it evenly"
    )
    min_advance: float = quantity(
        0.01, "m", "within the stall time, for a hand that comes on", "choice: far less than at full speed"
    )
    easing: LoadEasing = field(default_factory=LoadEasing)
    rest_timeout: float = quantity(
        10.0, "s", "for which the arm may sink before the strap is tucked", "choice: it sinks in less"
    )
    rest_motion: float = quantity(
        0.015, "m", "of any joint within the stall time, below which the arm rests", "choice: above the tracker's noise"
    )
    tuck_speed: float = quantity(0.06, "m/s", "of the hand down beside the shoulder", "choice: slow, beside the person")
    tuck_timeout: float = quantity(
        3.0, "s", "for which the strap is tucked down at most", "choice: ends above the mattress"
    )
    tuck_clearance: float = quantity(
        0.04, "m", "of the hand above the mattress at the lowest", "choice: no contact with it"
    )
    tuck_max_load: float = quantity(
        5.5, "N", "load from which the strap is tucked no further", "choice: harder, it would draw at the other sleeve"
    )
    tuck_room: float = quantity(
        0.06,
        "m",
        "of the hand headward of the shoulder, from which there is room to go down behind it",
        "design: radius of a shoulder, half a finger and the tracker's error; above the shoulder, fingers met it",
    )
    law: PullLaw = field(default_factory=PullLaw)


class SeatSleeve(Skill):
    """Draws the strap on towards the head of the bed, keeps it there while the arm sinks, tucks it down.

    The lower half of the armhole lags behind the strap and comes along that way; an arm that sinks after the strap
    was let go draws the sleeve back by a tenth of its length; a strap that is let go of above the shoulder springs back
    over it, one that is let go of behind it stays.  It ends with the hand still closed: a strap that is slackened
    before it is let go of draws the armhole back (measured: to 0.53 of the upper arm; let go of under load: 0.71).
    It fails where the guard stops a load that is too high, and where the person moves; an arm that was never found is
    no reason to wait for it.
    """

    grip = Input(StrapGrip, doc="how the strap is held")
    max_load = Input(float, unit="N", default=4.5, doc="load at which the strap is drawn no farther")
    tuning = Input(SeatSleeveTuning, default=SeatSleeveTuning(), doc="numbers of this skill")
    reasons = (Reason.ARM_LOST, Reason.FORCE_LIMIT, Reason.PERSON_MOVED)

    def steps(self) -> Iterator[None]:
        """Seat the sleeve as long as the person does not move."""
        yield from while_person_rests(self, self._seat())

    def _seat(self) -> Iterator[None]:
        """Draw, hold, tuck."""
        yield from self._draw()
        self.note(f"holds the {self.grip.arm} sleeve until the arm rests")
        yield from self._hold()
        self.note(f"tucks the {self.grip.arm} sleeve behind the shoulder")
        yield from self._tuck()

    def _draw(self) -> Iterator[None]:
        """Headward until far enough, at the greatest load, or standing."""
        tuning = self.tuning
        n, window = SIDES.index(self.grip.hand), deque[tuple[float, float]]()
        start = self.world.observe().pose_hand_in_map[n, :3, 3]
        farthest = min(tuning.max_draw, self._shoulder_ahead(start) + tuning.max_beyond)
        while True:
            seen, load = self.world.observe(), cloth_load(self, self.grip.hand)
            gone = float((seen.pose_hand_in_map[n, :3, 3] - start) @ HEADWARD)
            window.append((seen.time, gone))
            while window[0][0] < seen.time - tuning.stall_time:
                window.popleft()
            recorded = seen.time - window[0][0]
            stands = recorded > tuning.stall_record * tuning.stall_time and gone - window[0][1] < tuning.min_advance
            if gone > farthest or np.linalg.norm(load) > self.max_load or stands:
                return
            self.note(f"draws the {self.grip.arm} sleeve headward: {gone * 100:.0f} cm, {np.linalg.norm(load):.1f} N")
            ease = tuning.easing.share(load, self.max_load) * tuning.law.ease(load)
            linear = tuning.draw_speed * ease * HEADWARD
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=np.append(linear, np.zeros(3))))
            yield

    def _shoulder_ahead(self, start: np.ndarray) -> float:
        """How far headward of `start` (3,) the shoulder is [m]; 0 for an arm that was never found."""
        try:
            return float((watch_arm(self, self.grip.arm).points_in_map[0] - start) @ HEADWARD)
        except PerceptionFailure:
            return 0.0

    def _hold(self) -> Iterator[None]:
        """Wait for the arm to come to rest, as far as it is seen."""
        tuning, window = self.tuning, deque[tuple[float, np.ndarray]]()
        end = self.now() + tuning.rest_timeout
        while self.now() < end:
            try:
                window.append((self.now(), watch_arm(self, self.grip.arm).points_in_map))
            except PerceptionFailure:
                return
            while window[0][0] < self.now() - tuning.stall_time:
                window.popleft()
            sunk = float(np.linalg.norm(window[-1][1] - window[0][1], axis=1).max())
            if self.now() - window[0][0] > tuning.stall_record * tuning.stall_time and sunk < tuning.rest_motion:
                return
            yield

    def _tuck(self) -> Iterator[None]:
        """Down beside the shoulder, almost to the mattress, until it pulls too hard; not at all without room for it."""
        tuning, n = self.tuning, SIDES.index(self.grip.hand)
        if self._shoulder_ahead(self.world.observe().pose_hand_in_map[n, :3, 3]) > -tuning.tuck_room:
            return
        end = self.now() + tuning.tuck_timeout
        floor = float(self.world.room.bed[1, 2]) + tuning.tuck_clearance
        while self.now() < end:
            height = float(self.world.observe().pose_hand_in_map[n, 2, 3])
            if height < floor or np.linalg.norm(cloth_load(self, self.grip.hand)) > tuning.tuck_max_load:
                return
            twist = np.array((0.0, 0.0, -tuning.tuck_speed, 0.0, 0.0, 0.0))
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=twist))
            yield

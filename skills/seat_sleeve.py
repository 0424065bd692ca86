"""Stage C: once the strap is over the shoulder, draw it headward, tuck it down behind the shoulder, and slacken it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.image.cloud import unit
from ..sim.world import SIDES, HandTwist
from .belief.person_tracking import watch_arm
from .control.hands import cloth_load
from .control.pull_law import PullLaw
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.stances import HEADWARD
from .geometry.strap_grip import StrapGrip
from .pull_along_arm import EASING, SLOWEST

FARTHEST = 0.08  # the strap is drawn at most this far [m]
SPEED = 0.11  # [m/s]
WINDOW, STANDS = 1.6, 0.01  # a hand that comes on less than that [m] in this time [s] stands
ABOVE_BED, TUCKED = 0.04, 5.5  # where a tucked strap is at the lowest [m], and how hard it may pull there [N]
DOWN, TUCKING = 0.06, 3.0  # [m/s], for so long at most [s]
SLACK, GIVING, SLACKENING = 0.8, 0.04, 4.0  # a slack strap's load [N], on the way there [m/s], for so long at most [s]
SINKING, RESTS = 10.0, 0.015  # a loose arm sinks at most so long [s]; less than this in WINDOW is rest [m]


class SeatSleeve(Skill):
    """Draws the strap on towards the head of the bed, keeps it there while the arm sinks, tucks it down, slackens it.

    The lower half of the armhole lags behind the strap and comes along that way; an arm that sinks after the strap
    was let go draws the sleeve back by a tenth of its length; a strap that is let go of above the shoulder springs back
    over it, one that is let go of behind it stays.  It ends with the hand still closed.

    Inputs: `grip`, how the strap is held; `taut`, how hard it is drawn at most [N]; `law`, constants of the pull.
    """

    grip = Input(StrapGrip)
    taut = Input(float, default=4.5)
    law = Input(PullLaw, default=PullLaw())
    reasons = (Reason.ARM_LOST, Reason.FORCE_LIMIT)

    def steps(self) -> Iterator[None]:
        """Draw, hold, tuck, slacken."""
        yield from self._draw()
        self.note(f"holds the {self.grip.arm} sleeve until the arm rests")
        yield from self._hold()
        self.note(f"tucks the {self.grip.arm} sleeve behind the shoulder")
        yield from self._tuck()
        self.note(f"slackens the {self.grip.arm} sleeve")
        yield from self._slacken()

    def _draw(self) -> Iterator[None]:
        """Headward until far enough, taut, or standing."""
        n, window = SIDES.index(self.grip.hand), deque[tuple[float, float]]()
        start = self.world.observe().pose_hand_in_map[n, :3, 3]
        while True:
            seen, load = self.world.observe(), cloth_load(self, self.grip.hand)
            gone = float((seen.pose_hand_in_map[n, :3, 3] - start) @ HEADWARD)
            window.append((seen.time, gone))
            while window[0][0] < seen.time - WINDOW:
                window.popleft()
            stands = seen.time - window[0][0] > 0.9 * WINDOW and gone - window[0][1] < STANDS
            if gone > FARTHEST or np.linalg.norm(load) > self.taut or stands:
                return
            self.note(f"draws the {self.grip.arm} sleeve headward: {gone * 100:.0f} cm, {np.linalg.norm(load):.1f} N")
            ease = float(np.clip((self.taut - np.linalg.norm(load)) / EASING, SLOWEST, 1.0)) * self.law.ease(load)
            linear = SPEED * ease * HEADWARD
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=np.append(linear, np.zeros(3))))
            yield

    def _hold(self) -> Iterator[None]:
        """Wait for the arm to come to rest, as far as it is seen."""
        window: deque[tuple[float, np.ndarray]] = deque()
        end = self.now() + SINKING
        while self.now() < end:
            try:
                window.append((self.now(), watch_arm(self, self.grip.arm).points_in_map))
            except PerceptionFailure:
                return
            while window[0][0] < self.now() - WINDOW:
                window.popleft()
            sunk = float(np.linalg.norm(window[-1][1] - window[0][1], axis=1).max())
            if self.now() - window[0][0] > 0.9 * WINDOW and sunk < RESTS:
                return
            yield

    def _tuck(self) -> Iterator[None]:
        """Down beside the shoulder, almost to the mattress, until it pulls too hard or nothing gives."""
        n, end = SIDES.index(self.grip.hand), self.now() + TUCKING
        floor = float(self.world.room.bed[1, 2]) + ABOVE_BED
        while self.now() < end:
            height = float(self.world.observe().pose_hand_in_map[n, 2, 3])
            if height < floor or np.linalg.norm(cloth_load(self, self.grip.hand)) > TUCKED:
                return
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=np.array((0.0, 0.0, -DOWN, 0.0, 0.0, 0.0))))
            yield

    def _slacken(self) -> Iterator[None]:
        """Follow the cloth's pull until it hardly pulls: let go taut, it snaps back too far."""
        end = self.now() + SLACKENING
        while self.now() < end:
            load = cloth_load(self, self.grip.hand)
            if np.linalg.norm(load) < SLACK:
                return
            twist = np.append(GIVING * unit(load), np.zeros(3))
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=twist))
            yield

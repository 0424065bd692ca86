"""Stage B: lay the unfolded gown on the person, outside up, neckline just beyond the fingertips of the resting arms."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.world import SIDES, Side
from .control.base import drive_to
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands
from .control.head import look_towards
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.stances import STANCES
from .motion.errors import MotionError

BEGIN = 1.25  # y of the neckline when the hem begins to touch the legs [m]
# y and z of the neckline on its way down: the hem trails towards the feet, so that the outside ends up on top
PATH = ((0.80, 1.15), (0.40, 0.98), (0.16, 0.87))
CENTRE, NEAREST = 0.0, 0.35  # x of the middle of the neckline, and of the near hand at least [m]
DRIVE, LOWER = 0.35, 0.25  # [m/s]
# The far armhole hides behind its hand, but both together are wider than the hands are apart: by 0.04 m in the median
# of nine gowns, by -0.03 to 0.11.  What shows of the near one is that much nearer to the middle of the bed than all of
# it.  The gown follows the hands half way [m].
NEAR: Side = "left"
OVER_NEAR: Side = "right"  # the wearer's side that it holds
BEYOND, HIDDEN, FOLLOWS = 0.04, 0.02, 2.0
STRAIGHT, FARTHEST = 0.03, 0.12  # askew by less is let pass; the hands go no farther to the side [m]
SLACK, BY, NARROWER = 0.5, 0.03, 5  # pull of a slack neckline [N]; the hands come together by so much [m], so often


class LayGown(Skill):
    """Slides along the bed towards the head while the hands come down, then lets go and withdraws upwards.

    Inputs: `width` between the two hands [m].  Expects the gown between both hands, outside facing the robot.
    """

    width = Input(float)
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.PATH_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Drive and lower in turn; then open, rise, drive back."""
        self.note("lays the gown on the person")
        self._apart, self._middle = self.width, CENTRE
        yield from drive_to(self, np.array((STANCES.lane, BEGIN + STANCES.ahead, STANCES.heading)), speed=0.4)
        for share in (0.25, 0.5, 0.75):  # over the bed in steps: the hands cross before the chest one behind the other
            try:
                yield from self._hands_to(BEGIN, 1.28, share)
            except MotionError:
                continue  # the next step may have a way
        yield from self._hands_to(BEGIN, 1.28)
        before = BEGIN
        for y, z in PATH:  # down first: what then touches is drawn after the neckline, and nothing gets ahead of it
            yield from self._hands_to(before, z)
            yield from drive_to(
                self, np.array((STANCES.lane, y + STANCES.ahead, STANCES.heading)), speed=DRIVE, straight=True
            )
            before = y
        yield from self._hands_to(*PATH[-1])
        yield from self._centre()
        for side in SIDES:  # the near corner first: then its back panel swings out over the edge of the bed
            yield from open_gripper(self, side)
        self.note("withdraws")
        up: dict[Side, np.ndarray] = {side: hand_now(self, side) for side in SIDES}
        for pose in up.values():
            pose[:3, 3] += (0.0, 0.06, 0.22)
        yield from move_hands(self, up, speed=0.3, free="any", retreat=True)
        yield from drive_to(self, np.array((STANCES.lane, 1.6, STANCES.heading)), straight=True, retreat=True)

    def _centre(self) -> Iterator[None]:
        """Draw a gown that was taken askew, longer on the far side, towards the near side.

        The far side would fall over the edge of the bed, draw the gown after it, and catch on the hand there.
        """
        near = hand_now(self, NEAR)[:3, 3]
        yield from look_towards(self, near)
        try:
            seen = self.context.senses.sleeve_opening(self.world.look("head"), side=OVER_NEAR, near_in_map=near)
        except PerceptionFailure:
            return  # it stays as it was taken
        askew = float(np.median(seen.ring_points_in_map[:, 0])) + HIDDEN - (self.width + BEYOND) / 2
        if askew < -STRAIGHT:
            self._middle = CENTRE + min(-FOLLOWS * askew, FARTHEST)
            with suppress(MotionError):  # then it stays where it is
                yield from self._hands_to(*PATH[-1])
                yield from self._slacken()

    def _slacken(self) -> Iterator[None]:
        """Bring the hands together until the neckline between them is slack.

        Let go of at one end while it is taut, it draws the gown to the other side again.  Only a gown that was askew is
        slackened: sleeves that do not hang over the edges of the bed may fold inwards.
        """
        for _ in range(NARROWER):
            near, far = (float(cloth_load(self, side)[0]) for side in SIDES)
            if (far - near) / 2 < SLACK:
                return
            self._apart -= BY
            yield from self._hands_to(*PATH[-1])

    def _hands_to(self, y: float, z: float, share: float = 1.0) -> Iterator[None]:
        """Both hands to the ends of a neckline at (y, z), or a `share` of the way there, however they turn."""
        half = self._apart / 2
        goals: dict[Side, np.ndarray] = {}
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            pose = hand_now(self, side)
            there = np.array((max(self._middle, NEAREST - half) + sign * half, y, z))
            pose[:3, 3] += share * (there - pose[:3, 3])
            goals[side] = pose
        yield from move_hands(self, goals, speed=LOWER, free="any", way="either")

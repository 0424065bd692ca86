"""Lay the unfolded gown on the person, outside up, the neckline just beyond the fingertips of the resting arms."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.quantity import Quantities, quantity
from ..sim.world import SensorLost
from .belief.lying_sleeves import lying_sleeves, remember_laid
from .control.base import drive_to
from .control.draw_across import DrawAcrossTuning, draw_across
from .control.hands import hand_now
from .control.head import look_towards
from .control.held_neckline import NEAR_HAND, NEAR_SLEEVE, HeldNeckline, NecklineTuning
from .control.leave_gown import LeaveGownTuning, leave_gown
from .control.together import together
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.arm_path import UP
from .geometry.stances import STANCES, outwards
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class LayGownTuning(Quantities):
    """Numbers of `LayGown`.  Places are in the map, whose origin is the middle of the bed: y is towards the feet."""

    start_y: float = quantity(1.25, "m", "of the neckline at first", "choice: the hem begins to touch the legs")
    start_height: float = quantity(1.28, "m", "of the neckline at first", "choice: the hem is just above the bed")
    start_shares: tuple[float, float] = quantity(
        (0.33, 0.67),
        "1",
        "shares of what is left of the hands' way to the start at which they come between",
        "choice: the hands cross before the chest one behind the other",
    )
    descent: tuple[tuple[float, float], tuple[float, float], tuple[float, float]] = quantity(
        ((0.80, 1.15), (0.40, 0.98), (0.40, 0.87)),
        "m",
        "y and height of the neckline on its way down",
        "choice: the hem trails towards the feet, so that the outside ends up on top",
    )
    drawn_y: float = quantity(
        0.26,
        "m",
        "of the neckline as it goes down for its last way",
        "measured: lowered sooner after it had been swayed to and fro, one back panel was tucked in (126, 135)",
    )
    drawn_heights: tuple[float, ...] = quantity(
        (0.70, 0.74, 0.78, 0.82),
        "m",
        "of the neckline on its last way towards the head, tried in turn",
        "choice: the sleeves, on the bed by then, trail towards the feet, outside up; lowered at their place some "
        "turned over (283, 101 with arms that fall)",
    )
    end_y: float = quantity(0.16, "m", "of the neckline in the end", "choice: just beyond resting fingertips")
    end_heights: tuple[float, ...] = quantity(
        (0.66, 0.70, 0.74, 0.78, 0.82),
        "m",
        "of the neckline in the end, tried in turn",
        "choice: as near to the bed, whose top is at 0.58 m, as the hands get straight down",
    )
    middle_x: float = quantity(0.0, "m", "of the middle of the neckline", "design: the middle of the bed")
    near_stands: float = quantity(
        0.04,
        "m",
        "above its armhole, of the cuff of the near sleeve, as it is seen before the gown is let go of",
        "measured: 0.04 to 0.11 m of 15 gowns whose first sleeve went on, 0.047 to 0.108 m of six more, -0.07, -0.02 "
        "and 0.00 m of the three whose near panel was tucked in (120, 124, 129), 0.036 m of one whose sleeve stopped "
        "0.3 m short three times (103)",
    )
    near_inwards: float = quantity(
        0.06,
        "m",
        "towards the midline from its armhole, of that cuff, from which the sleeve lies folded over",
        "measured: 0.01 m and less of six gowns whose first sleeve went on, 0.09 m of one whose sleeve did not open, "
        "twice, until the gown was on the floor (131)",
    )
    neckline: NecklineTuning = field(default_factory=NecklineTuning)
    across: DrawAcrossTuning = field(default_factory=DrawAcrossTuning)
    leave: LeaveGownTuning = field(default_factory=LeaveGownTuning)
    approach_speed: float = quantity(0.4, "m/s", "of the base on its way to the bed", "choice: the gown hardly swings")
    base_speed: float = quantity(0.35, "m/s", "of the base along the bed", "choice: the gown is drawn, not dropped")


class LayGown(Skill):
    """Slides along the bed towards the head while the hands come down, then lets go and withdraws upwards.

    The gown is between both hands, its outside towards the robot.  One that was taken askew, with more of it on one
    side, is laid nearer to the other.  Where the back panel on the robot's side has come to lie under the front, or
    folded over it, its sleeve does not stand, or points inwards; held still, the gown is then taken up and laid once
    more, the near end lower and behind, so that the bed draws that panel outwards.
    """

    width = Input(float, unit="m", doc="distance between the hands")
    tuning = Input(LayGownTuning, default=LayGownTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.PATH_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Drive and lower in turn; then open, rise, drive back."""
        tuning = self.tuning
        self.note("lays the gown on the person")
        neckline = HeldNeckline(self, self.width, tuning.middle_x, tuning.neckline)
        lying_sleeves(self.context).clear()  # of a gown that was laid before
        yield from drive_to(self, self._base_for(tuning.start_y), speed=tuning.approach_speed)
        for share in tuning.start_shares:
            with suppress(MotionError):  # the next step may have a way
                yield from neckline.to(tuning.start_y, tuning.start_height, share)
        yield from self._lay_down(neckline)
        if not (yield from self._near_stands()):
            self.note("lays it once more, the near end lower")
            yield from self._take_up(neckline)
            neckline.lower = NEAR_HAND
            yield from self._lay_down(neckline)
            yield from self._near_stands()
        remember_laid(self.context)
        yield from leave_gown(self, tuning.leave)

    def _lay_down(self, neckline: HeldNeckline) -> Iterator[None]:
        """From above the feet down along the person, to just beyond the fingertips."""
        tuning = self.tuning
        before = tuning.start_y
        yield from neckline.to(before, tuning.start_height)
        # down first: what then touches is drawn after the neckline, and nothing gets ahead of it
        for y, z in tuning.descent:
            yield from neckline.to(before, z)
            if y != before:
                drive = drive_to(self, self._base_for(y), speed=tuning.base_speed, straight=True)
                yield from together(drive, look_towards(self, hand_now(self, NEAR_HAND)[:3, 3]))  # it comes along
            before = y
        yield from draw_across(neckline, *tuning.descent[-1], tuning.across)
        yield from drive_to(self, self._base_for(tuning.drawn_y), speed=tuning.base_speed, straight=True)
        yield from self._lower(neckline, tuning.drawn_y, tuning.drawn_heights)
        yield from drive_to(self, self._base_for(tuning.end_y), speed=tuning.base_speed, straight=True)
        yield from self._lower(neckline, tuning.end_y, tuning.end_heights)

    def _near_stands(self) -> Generator[None, None, bool]:
        """Look whether the near sleeve stands on the gown, its cuff above its armhole and not folded inwards.

        It is remembered, for whoever dresses the arms.  One that does not show may stand, unless it was
        seen not to before it was laid once more.
        """
        lying = lying_sleeves(self.context)
        yield from look_towards(self, hand_now(self, NEAR_HAND)[:3, 3])
        with suppress(PerceptionFailure, SensorLost):
            seen = self.context.senses.sleeve_heading(
                self.world.look("head"), side=NEAR_SLEEVE, near_in_map=hand_now(self, NEAR_HAND)[:3, 3]
            )
            lying.discard(NEAR_SLEEVE)
            cuff, tuning = seen.cuff_from_armhole_in_map, self.tuning
            if cuff @ UP < tuning.near_stands or cuff @ -outwards(NEAR_SLEEVE) > tuning.near_inwards:
                lying.add(NEAR_SLEEVE)
        return NEAR_SLEEVE not in lying

    def _take_up(self, neckline: HeldNeckline) -> Iterator[None]:
        """Back to above the feet, the way it came: up first at each place, so that nothing is drawn after the hem."""
        tuning, y = self.tuning, self.tuning.end_y
        for to_y, z in (tuning.descent[1], tuning.descent[0], (tuning.start_y, tuning.start_height)):
            yield from neckline.to(y, z)
            yield from drive_to(self, self._base_for(to_y), speed=tuning.base_speed, straight=True)
            y = to_y

    def _base_for(self, y: float) -> np.ndarray:
        """Base pose (3,) in the map from which the hands hold the neckline at `y` [m, m, rad]."""
        return np.array((STANCES.lane, y + STANCES.ahead, STANCES.heading))

    def _lower(self, neckline: HeldNeckline, y: float, heights: tuple[float, ...]) -> Iterator[None]:
        """Bring both ends of the neckline straight down to the lowest of `heights` [m] that is in reach.

        Any other way there may lead over the person: a hand that swung round came down on the belly with 57 N (115).
        Where the lowest is out of reach, they stop one above where they just get to: the far arm of a UR5 pair ended
        at its full stretch.

        Let go of in the air, sleeves that the hands' way across had tucked in turned over as they fell, and pointed
        back at the person's hand as they were held out (148, 150, 156, 190, 194).
        """
        lowest = next((n for n, height in enumerate(heights) if neckline.reaches(y, height)), len(heights))
        above = lowest if lowest == 0 else min(lowest + 1, len(heights) - 1)
        for height in heights[above:]:
            with suppress(MotionError):
                yield from neckline.to(y, height, way="line")
                return

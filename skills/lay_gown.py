"""Lay the unfolded gown on the person, outside up, the neckline just beyond the fingertips of the resting arms."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, SensorLost, Side
from .control.base import drive_to
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands
from .control.head import look_towards
from .core.ports import Input
from .core.reasons import Reason
from .core.skill import Skill
from .geometry.stances import STANCES
from .motion.errors import MotionError

# The robot slides along the person's right side, facing the head of the bed.
NEAR_HAND: Side = "left"  # the hand nearer to the robot's edge of the bed
NEAR_SLEEVE: Side = "right"  # the wearer's side of the sleeve that this hand holds


@dataclass(frozen=True, kw_only=True)
class LayGownTuning(Quantities):
    """Numbers of `LayGown`.  Places are in the map, whose origin is the middle of the bed: y is towards the feet."""

    start_y: float = quantity(1.25, "m", "of the neckline at first", "choice: the hem begins to touch the legs")
    start_height: float = quantity(1.28, "m", "of the neckline at first", "choice: the hem is just above the bed")
    start_shares: tuple[float, float, float] = quantity(
        (0.25, 0.5, 0.75),
        "1",
        "shares of the hands' way to the start at which they come between",
        "choice: the hands cross before the chest one behind the other",
    )
    descent: tuple[tuple[float, float], tuple[float, float], tuple[float, float]] = quantity(
        ((0.80, 1.15), (0.40, 0.98), (0.22, 0.87)),
        "m",
        "y and height of the neckline on its way down",
        "choice: the hem trails towards the feet, so that the outside ends up on top",
    )
    end_y: float = quantity(0.16, "m", "of the neckline in the end", "choice: just beyond resting fingertips")
    end_heights: tuple[float, ...] = quantity(
        (0.66, 0.74),
        "m",
        "of the neckline in the end, tried in turn",
        "choice: as near to the bed, whose top is at 0.58 m, as the hands get",
    )
    middle_x: float = quantity(0.0, "m", "of the middle of the neckline", "design: the middle of the bed")
    min_near_x: float = quantity(
        0.35,
        "m",
        "of the near hand, at least",
        "choice: how it was found is not recorded; nearer, the hand is beside the base",
    )
    approach_speed: float = quantity(0.4, "m/s", "of the base on its way to the bed", "choice: the gown hardly swings")
    base_speed: float = quantity(0.35, "m/s", "of the base along the bed", "choice: the gown is drawn, not dropped")
    speed: float = quantity(0.25, "m/s", "of each hand", "choice: the gown hardly swings")
    overhang: float = quantity(
        0.04,
        "m",
        "by which the armholes' outer edges are farther apart than the hands",
        "measured: median of nine gowns, from -0.03 to 0.11",
    )
    hidden_offset: float = quantity(
        0.02,
        "m",
        "from the middle of what shows of the near armhole outwards to its whole",
        "choice: how it was found is not recorded; the rest of the near armhole is hidden",
    )
    min_askew: float = quantity(
        0.03,
        "m",
        "by which the far side is longer before the gown is drawn across",
        "choice: less is within the error of what is seen",
    )
    shift_factor: float = quantity(
        2.0, "1", "way of the hands for each metre that the gown is to go", "choice: the gown follows them half way"
    )
    max_shift: float = quantity(0.12, "m", "of the hands towards the near side", "choice: within the arms' reach")
    slack_load: float = quantity(
        0.5, "N", "pull of the neckline on a hand below which it is slack", "choice: above the noise"
    )
    narrowing: float = quantity(
        0.03,
        "m",
        "by which the hands come together at once to slacken the neckline",
        "choice: small, so that it hangs through no more than needed",
    )
    max_narrowings: int = quantity(
        5, "1", "times that they do so", "choice: a gown that still pulls then is let go of as it is"
    )
    sway: float = quantity(
        0.06,
        "m",
        "of the hands across the bed and back, to either side, by which the gown is weighed",
        "choice: more than friction holds; from what it pulls after either, friction cancels",
    )
    sway_rest: float = quantity(0.5, "s", "before the pull is read", "choice: the cloth stops swinging")
    load_samples: int = quantity(
        6, "1", "readings of the force sensors whose mean counts", "choice: a third of a second"
    )
    uneven_load: float = quantity(
        0.15,
        "N",
        "of the gown across the bed, from which one side would draw all of it over the edge",
        "measured: 0.31 to 0.62 N in four gowns that slid by 0.15 to 0.25 m as they were let go of (126, 135, 174, "
        "188); 0.00 to 0.33 N in six that stayed, 0.09 N in one that slid by 0.1 m (121 to 145)",
    )
    even_shift: float = quantity(
        0.15,
        "m/N",
        "by which the hands go to the other side for it",
        "measured: let go of in the air, the gown went half of 0.3 m/N back; all four then stayed within 0.10 m of the "
        "middle",
    )
    max_even_shift: float = quantity(
        0.06, "m", "by which they do so at most", "measured: by 0.12 m, of a gown that stayed there, too far (154, 156)"
    )
    withdrawal: tuple[float, float, float] = quantity(
        (0.0, 0.06, 0.22), "m", "of the open hands in the map", "choice: up and off the cloth, towards the feet"
    )
    withdrawal_speed: float = quantity(0.3, "m/s", "of the open hands", "choice: they hold nothing")
    final_y: float = quantity(1.6, "m", "of the base in the end", "choice: the arms are clear of the bed")


class LayGown(Skill):
    """Slides along the bed towards the head while the hands come down, then lets go and withdraws upwards.

    The gown is between both hands, its outside towards the robot.  A gown that was taken askew, with more of it on the
    far side, is drawn across to the near side before it is let go of, and one of which more hangs over one edge of the
    bed to the other side.
    """

    width = Input(float, unit="m", doc="distance between the hands")
    tuning = Input(LayGownTuning, default=LayGownTuning(), doc="numbers of this skill")
    reasons = (Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.COMMAND_LOST, Reason.PATH_BLOCKED, Reason.TIMEOUT)

    def steps(self) -> Iterator[None]:
        """Drive and lower in turn; then open, rise, drive back."""
        tuning = self.tuning
        self.note("lays the gown on the person")
        self._apart, self._middle = self.width, tuning.middle_x
        yield from drive_to(self, self._base_for(tuning.start_y), speed=tuning.approach_speed)
        for share in tuning.start_shares:
            with suppress(MotionError):  # the next step may have a way
                yield from self._hands_to(tuning.start_y, tuning.start_height, share)
        yield from self._hands_to(tuning.start_y, tuning.start_height)
        before = tuning.start_y
        for (
            y,
            z,
        ) in tuning.descent:  # down first: what then touches is drawn after the neckline, and nothing gets ahead of it
            yield from self._hands_to(before, z)
            yield from drive_to(self, self._base_for(y), speed=tuning.base_speed, straight=True)
            before = y
        yield from self._hands_to(*tuning.descent[-1])
        yield from self._centre()
        yield from self._even_out()
        yield from drive_to(self, self._base_for(tuning.end_y), speed=tuning.base_speed, straight=True)
        yield from self._lay_down()
        for side in SIDES:  # the near corner first: then its back panel swings out over the edge of the bed
            yield from open_gripper(self, side)
        self.note("withdraws")
        up: dict[Side, np.ndarray] = {side: hand_now(self, side) for side in SIDES}
        for pose in up.values():
            pose[:3, 3] += tuning.withdrawal
        yield from move_hands(self, up, speed=tuning.withdrawal_speed, free="any", retreat=True)
        away = np.array((STANCES.lane, tuning.final_y, STANCES.heading))
        yield from drive_to(self, away, straight=True, retreat=True)

    def _base_for(self, y: float) -> np.ndarray:
        """Base pose (3,) in the map from which the hands hold the neckline at `y` [m, m, rad]."""
        return np.array((STANCES.lane, y + STANCES.ahead, STANCES.heading))

    def _centre(self) -> Iterator[None]:
        """Draw a gown that was taken askew, with more of it on the far side, towards the near side.

        The far side would fall over the edge of the bed, draw the gown after it, and catch on the person's hand there.
        The far armhole hides behind the hand that holds it, so what is askew is told by the near one alone.
        """
        tuning = self.tuning
        near = hand_now(self, NEAR_HAND)[:3, 3]
        yield from look_towards(self, near)
        try:
            seen = self.context.senses.sleeve_opening(self.world.look("head"), side=NEAR_SLEEVE, near_in_map=near)
        except (PerceptionFailure, SensorLost):
            return  # it stays as it was taken
        shown = float(np.median(seen.armhole_points_in_map[:, 0]))
        askew = shown + tuning.hidden_offset - (self.width + tuning.overhang) / 2
        if askew < -tuning.min_askew:
            self._middle = tuning.middle_x + min(-tuning.shift_factor * askew, tuning.max_shift)
            with suppress(MotionError):  # then it stays where it is
                yield from self._hands_to(*tuning.descent[-1])
                yield from self._slacken()

    def _even_out(self) -> Iterator[None]:
        """Draw a gown of which more hangs over one edge of the bed to the other side.

        Let go of, what hung there drew all of it along, by 0.15 to 0.25 m within two seconds, and the first sleeve was
        out of reach of its hand from then on (126, 135, 174, 188).  No camera sees the edges below the robot's arms;
        the hands feel it, once friction is left out, which pulls back from either way.
        """
        tuning, middle, pulls = self.tuning, self._middle, []
        try:
            for sway in (tuning.sway, -tuning.sway):
                for self._middle in (middle + sway, middle):
                    yield from self._hands_to(*tuning.descent[-1])
                pulls.append((yield from self._pull()))
            if abs(pull := float(np.mean(pulls))) > tuning.uneven_load:
                self.note(f"{abs(pull):.1f} N more of the gown hang over the {'near' if pull > 0.0 else 'far'} edge")
                shift = float(np.clip(-tuning.even_shift * pull, -tuning.max_even_shift, tuning.max_even_shift))
                self._middle = middle + shift
                yield from self._hands_to(*tuning.descent[-1])
        except MotionError:
            return  # it stays where it is

    def _pull(self) -> Generator[None, None, float]:
        """How hard the gown pulls both hands together towards the near side [N]."""
        yield from self.wait(self.tuning.sway_rest)
        samples = []
        for _ in range(self.tuning.load_samples):
            samples.append(sum(float(cloth_load(self, side)[0]) for side in SIDES))
            yield
        return float(np.mean(samples))

    def _lay_down(self) -> Iterator[None]:
        """Bring both ends of the neckline down before the sleeves, which trail towards the feet.

        Let go of in the air, sleeves that the hands' way across had tucked in turned over as they fell, and pointed
        back at the person's hand as they were held out (148, 150, 156, 190, 194).
        """
        for height in self.tuning.end_heights:
            with suppress(MotionError):
                yield from self._hands_to(self.tuning.end_y, height)
                return

    def _slacken(self) -> Iterator[None]:
        """Bring the hands together until the neckline between them is slack.

        A stretched neckline that is let go of at one end draws the gown to the other side again.  Only a gown that was
        askew is slackened: sleeves that do not hang over the edges of the bed may fold inwards.
        """
        tuning = self.tuning
        for _ in range(tuning.max_narrowings):
            near, far = (float(cloth_load(self, side)[0]) for side in SIDES)
            if (far - near) / 2 < tuning.slack_load:
                return
            self._apart -= tuning.narrowing
            yield from self._hands_to(*tuning.descent[-1])

    def _hands_to(self, y: float, z: float, share: float = 1.0) -> Iterator[None]:
        """Both hands to the ends of a neckline at (y, z) [m, map], or a `share` of the way there, turned anyhow."""
        half = self._apart / 2
        goals: dict[Side, np.ndarray] = {}
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            pose = hand_now(self, side)
            there = np.array((max(self._middle, self.tuning.min_near_x - half) + sign * half, y, z))
            pose[:3, 3] += share * (there - pose[:3, 3])
            goals[side] = pose
        yield from move_hands(self, goals, speed=self.tuning.speed, free="any", way="either")

"""Look whether an arm is inside its sleeve, and how far up the sleeve is, while nothing stands before them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.image.cloud import unit
from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.close_look import CloseLook, SleeveSeen, sleeve_seen
from .belief.person_tracking import watch_arm
from .belief.pulled_sleeves import pull_loads
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import UP


@dataclass(frozen=True, kw_only=True)
class CheckSleeveTuning(Quantities):
    """What shows of the cuff where the arm is inside the sleeve."""

    min_cuff_at: float = quantity(
        0.15,
        "1",
        "share of the upper arm, from the shoulder, where the cuff shows at least",
        "measured: recorded runs: 0.29 to 0.77, 0.01 and 0.05 where the sleeve lay in a heap at the shoulder",
    )
    upper_arm: tuple[float, float] = quantity(
        (0.05, 0.35), "1", "part of the upper arm, from the shoulder, that a sleeve covers", "choice: short ones too"
    )
    min_covered: float = quantity(
        0.25,
        "1",
        "share of that which shows something else than skin, or no sleeve is on it",
        "measured: from beside 16 arms in their sleeves all of it does, of 18 bare ones none (169 to 192)",
    )
    points: int = quantity(9, "1", "along it that are looked at", "choice: one a centimetre")
    outer: float = quantity(
        0.035, "m", "outwards of the arm's axis, where a sleeve covers it too", "choice: just inside of its outline"
    )
    inner_part: float = quantity(
        0.7, "1", "of the way between armhole and cuff that is looked at there", "choice: clear of both bindings"
    )
    min_outer_covered: float = quantity(
        0.5,
        "1",
        "share of that which shows something else than skin",
        "measured: 0.67 and more in 76 looks at sleeves that were on (176, 177, 179), 0.33 where one lay along its "
        "arm, on the trunk, and its cuff half round it (178); from the head of the bed two that were on showed 0.11 "
        "and 0.44 (178), so it is asked from beside alone",
    )
    min_share_round: float = quantity(
        0.45,
        "1",
        "share of the way round the arm that the cuff shows at least",
        "measured: recorded runs: 0.50 to 0.92, 0.17, 0.33 and 0.42 where the sleeve lay beside the arm (149), 0.42 "
        "where it was inside out on it (147); drawn again from beside the shoulder, all of 161 views of sleeves that "
        "sit show half and more, 19 of 21 of arms beside theirs a third at most; sleeves that have slipped to the "
        "wrist show less; two arms inside showed 0.33: one whose posture was out of date (31), and one on seed 3, not "
        "looked into",
    )
    min_round_closely: float = quantity(
        0.5,
        "1",
        "of the way round that a close look, in several pictures, shows more of but for the widest gap, whatever this "
        "one shows",
        "design: a cuff beside the arm lies within half of the directions off its axis.  Measured: 95 % of sleeves "
        "that sit do (four development seeds); from beside alone, 2 of 22 of them showed 0.42 (137, 128)",
    )
    max_inside_out: float = quantity(
        0.75,
        "1",
        "of the fabric between its bindings that shows the gown's inside, where one that was drawn up is on its arm",
        "measured: of 159 told to be on their arms, drawn again from beside, 0.63 and less of 151 that are, 0.86 and "
        "more of three of 8 that are not: the arm had come into a sleeve turned over from its wrong end, or beside it",
    )
    pulled_reach: float = quantity(
        0.45,
        "1",
        "of the upper arm, where a sleeve that was drawn up has its armhole at least",
        "measured: of 163 that were told to be on their arms (34 development seeds) 155 are at 0.52 and more; of the 8 "
        "below five lay beside their arm or the wrong way round it, and three were at 0.23 of it at most",
    )
    free_load: float = quantity(
        2.4,
        "N",
        "of a strap in the end of its way, below which what it drew up goes freely",
        "measured: 1.5 to 2.1 N with no arm in the sleeve (138, 193), in 1 of 47 with one less than 2.6 N, 1.9 N",
    )
    free_reach: float = quantity(
        0.65,
        "1",
        "of the upper arm, where such a sleeve has its armhole at least",
        "measured: 0.52 and 0.59 with no arm in it (138, 193), 0.75 and more with one (0)",
    )
    least_load: float = quantity(
        1.7,
        "N",
        "of a strap in the end of its way, below which no arm is in what it drew up, wherever that is seen",
        "measured: 1.4 N with no arm in it, the armhole seen at 0.81 (141); the least with one is 1.9 N (0)",
    )
    before_counts: float = quantity(
        0.7,
        "1",
        "of the armhole seen before, from elsewhere, in the mean of both looks",
        "measured: in 266 states of 11 development seeds that were drawn again from the head of the bed and from "
        "beside the arm, a bound on the mean with 0.7 of the first told more sleeves that are up and fewer that are "
        "not than with 0.5 or 0.6, or than either look alone",
    )


class CheckSleeve(Skill):
    """Looks where the cuff is: down the arm and round it, in a heap at the shoulder, or beside the arm.

    How far up it is, a close look tells, where there was one since the gown was touched (`LookAtSleeves`).
    It fails where the cuff is in a heap or beside the arm, where the upper arm shows bare, and where the armhole is too
    far down the arm; a sleeve of which too little shows is let pass, unless it `must_show`.
    """

    commands = False
    side = Input(Side, doc="arm of the person")
    min_reach = Input(
        float,
        unit="1",
        default=0.0,
        doc="how far up the upper arm the armhole of a sleeve that sits well is at least: 0 elbow, 1 shoulder",
    )
    seen_before = Input(
        float, unit="1", default=0.0, doc="how far up it was seen from elsewhere just before; 0 where it did not show"
    )
    min_together = Input(
        float, unit="1", default=0.0, doc="in the place of `min_reach` for the mean of both looks, where there are two"
    )
    min_now = Input(float, unit="1", default=0.0, doc="what this look has to tell, whatever was seen before")
    min_closely = Input(
        float,
        unit="1",
        default=0.0,
        doc="in the place of all of these, where it was looked at closely; 0: this look alone tells",
    )
    pulled = Input(
        bool, default=False, doc="whether the sleeve was drawn up just now: how hard and how far tells, and its side"
    )
    must_show = Input(bool, default=False, doc="whether one of which too little shows fails, as before a claim")
    tuning = Input(CheckSleeveTuning, default=CheckSleeveTuning(), doc="numbers of this skill")
    reach = Output(float, unit="1", doc="how far up the upper arm the armhole is seen; 0 where it does not show")
    reasons = (Reason.SLEEVE_MISSED, Reason.SLEEVE_LOW, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        arm = watch_arm(self, self.side).points_in_map
        closely = sleeve_seen(self, self.side) if self.min_closely > 0.0 else None
        try:
            seen = self.context.senses.worn_sleeve(self.world.look("head"), side=self.side, arm_in_map=arm)
        except PerceptionFailure as hidden:
            self._see_covered(arm)
            self.note(f"cannot see the {self.side} sleeve's bindings")
            if closely is not None:
                self._ask(closely.reach, self.min_closely)
            elif self.must_show:
                raise SkillFailure(Reason.NOTHING_SEEN, f"{hidden}") from None
            self.reach = 0.0 if closely is None else closely.reach
            return
        self.note(
            f"{self.side} armhole {seen.reach:.2f} up the upper arm, cuff at {seen.cuff_at:.2f}, "
            f"{seen.round_arm:.0%} round it"
        )
        CloseLook.of(self).before[self.side] = SleeveSeen(seen.reach, seen.round_arm, self.now())
        shows = seen.cuff_at >= self.tuning.min_cuff_at and seen.round_arm >= self.tuning.min_share_round
        surely = closely is not None and closely.round_arm > self.tuning.min_round_closely
        if not shows and not surely:
            raise SkillFailure(
                Reason.SLEEVE_MISSED,
                f"the cuff is at {seen.cuff_at:.2f} of the upper arm and shows "
                f"{seen.round_arm:.0%} of the way round it",
            )
        if self.pulled:
            self._see_pulled(seen.inside_out)
        self._see_outer_side(arm, seen.armhole_at, seen.cuff_at)
        self._ask(*self._told(seen.reach, closely))
        self.reach = seen.reach if closely is None else closely.reach
        yield

    def _told(self, now: float, closely: SleeveSeen | None) -> tuple[float, float]:
        """How far up the armhole is told to be, and has to be, by this look, one before, or a close one."""
        if closely is not None:
            return closely.reach, self.min_closely
        if now < self.min_now:
            return now, self.min_now
        if self.pulled:
            return now, self._least_pulled()
        if self.seen_before > 0.0:
            counts = self.tuning.before_counts
            return counts * self.seen_before + (1.0 - counts) * now, self.min_together
        return now, self.min_reach

    def _see_pulled(self, inside_out: float) -> None:
        """A sleeve that was drawn up just now pulled back, and shows its outside.

        Raises:
            SkillFailure: SLEEVE_MISSED.
        """
        if self._load() < self.tuning.least_load:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"it came up freely, with {self._load():.1f} N")
        if inside_out > self.tuning.max_inside_out:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"{inside_out:.0%} of the sleeve shows the gown's inside")

    def _least_pulled(self) -> float:
        """Where an armhole that was drawn up just now is at least, if there is an arm in it."""
        return self.tuning.free_reach if self._load() < self.tuning.free_load else self.tuning.pulled_reach

    def _load(self) -> float:
        """With which the strap pulled back in the end [N]; infinite where it did not come to its goal."""
        return pull_loads(self.context).get(self.side, np.inf)

    def _ask(self, reach: float, least: float) -> None:
        """The armhole is as far up as is asked for.

        Raises:
            SkillFailure: SLEEVE_LOW.
        """
        if reach < least:
            raise SkillFailure(
                Reason.SLEEVE_LOW, f"the armhole is at {reach:.2f} of the upper arm, at least {least:.2f} is asked for"
            )

    def _see_covered(self, arm: np.ndarray) -> None:
        """Whatever hides the bindings, a sleeve covers the top of its arm (4, 3).

        A gown that had been drawn up beside the arm lay in a heap behind the shoulder, its tapes inside, and passed.

        Raises:
            SkillFailure: SLEEVE_MISSED.
        """
        tuning = self.tuning
        along = np.linspace(*tuning.upper_arm, tuning.points)[:, None]
        try:
            seen = self.context.senses.skin_cover(
                self.world.look("head"), points_in_map=arm[0] + along * (arm[1] - arm[0])
            )
        except PerceptionFailure:
            return  # out of the picture
        if seen.share < tuning.min_covered:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"{1.0 - seen.share:.0%} of the upper arm show skin")

    def _see_outer_side(self, arm: np.ndarray, armhole_at: float, cuff_at: float) -> None:
        """A sleeve covers its arm (4, 3) on the outer side too; one that lies along it, on the trunk, does not.

        Raises:
            SkillFailure: SLEEVE_MISSED.
        """
        tuning = self.tuning
        shoulder, upper = arm[0], arm[1] - arm[0]
        aside = np.cross(UP, upper) if self.side == "left" else np.cross(upper, UP)
        margin = 0.5 * (1.0 - tuning.inner_part) * (cuff_at - armhole_at)
        along = np.linspace(armhole_at + margin, cuff_at - margin, tuning.points)[:, None]
        try:
            seen = self.context.senses.skin_cover(
                self.world.look("head"), points_in_map=shoulder + along * upper + tuning.outer * unit(aside)
            )
        except PerceptionFailure:
            return  # out of the picture
        if seen.share < tuning.min_outer_covered:
            raise SkillFailure(
                Reason.SLEEVE_MISSED, f"{1.0 - seen.share:.0%} of the arm's outer side between its bindings show skin"
            )

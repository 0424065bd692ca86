"""Look whether an arm that is not dressed yet has its hand inside the sleeve already."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....perception.errors import PerceptionFailure
from ....perception.image.cloud import unit
from ....sim.quantity import Quantities, quantity
from ....sim.world import Side
from ....skills.belief.person_tracking import watch_arm
from ....skills.core.ports import Input
from ....skills.core.reasons import Reason, SkillFailure
from ....skills.core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class CheckOverHandTuning(Quantities):
    """What shows of a sleeve that is over the hand, along the forearm: 0 elbow, 1 wrist."""

    max_armhole_at: float = quantity(0.9, "1", "where the armhole shows at most", "choice: past the wrist")
    min_length: float = quantity(
        0.2, "1", "of the forearm, by which the cuff shows beyond the armhole at least", "choice: a third of a sleeve"
    )
    min_round: float = quantity(
        0.45,
        "1",
        "share of the way round the arm that the cuff shows at least",
        "measured: with the other bounds, of 404 states of 11 development runs, hands open and away, it told 26 of "
        "26 with the sleeve over the hand, and none of the others (docs/dressing-findings.md)",
    )
    min_covered: float = quantity(
        0.5,
        "1",
        "share of the arm's axis between them that shows something else than skin",
        "measured: an arm that lay on the heap of its sleeve passed the other bounds, bare from shoulder to fingertip "
        "(138)",
    )
    points: int = quantity(9, "1", "along it that are looked at", "choice: one a centimetre or two")


class CheckOverHand(Skill):
    """Looks whether the sleeve is on its arm, past the wrist; it fails where it lies elsewhere, or does not show.

    A hand comes to be inside unasked, where an arm is lifted under its sleeve and put down again (0), and stays inside
    where what follows goes wrong.  Such a sleeve is drawn on from where it is: laid out anew, it would be taken off.
    """

    commands = False
    side = Input(Side, doc="the person's side")
    tuning = Input(CheckOverHandTuning, default=CheckOverHandTuning(), doc="numbers of this skill")
    reasons = (Reason.SLEEVE_MISSED, Reason.NOTHING_SEEN, Reason.ARM_LOST)

    def steps(self) -> Iterator[None]:
        """One look."""
        tuning = self.tuning
        arm = watch_arm(self, self.side).points_in_map
        try:
            seen = self.context.senses.sleeve_on_forearm(self.world.look("head"), side=self.side, arm_in_map=arm)
        except PerceptionFailure as hidden:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"{hidden}") from None
        covered = self._covered(arm, seen.armhole_at, seen.cuff_at)
        past_wrist = seen.armhole_at < tuning.max_armhole_at and seen.cuff_at > seen.armhole_at + tuning.min_length
        if not past_wrist or seen.round_arm < tuning.min_round or covered < tuning.min_covered:
            raise SkillFailure(
                Reason.SLEEVE_MISSED,
                f"armhole at {seen.armhole_at:.2f} of the forearm, cuff at {seen.cuff_at:.2f}, "
                f"{seen.round_arm:.0%} round it, {covered:.0%} covered",
            )
        self.note(f"the {self.side} sleeve is over the hand, its armhole at {seen.armhole_at:.2f} of the forearm")
        yield

    def _covered(self, arm: np.ndarray, armhole_at: float, cuff_at: float) -> float:
        """Share of the axis of an arm (4, 3) [m] between armhole and cuff that shows something else than skin."""
        shoulder, elbow, wrist, _ = arm
        along = np.linspace(armhole_at, min(cuff_at, 1.0), self.tuning.points)[:, None] * np.linalg.norm(wrist - elbow)
        points = elbow + np.where(along < 0.0, along * unit(elbow - shoulder), along * unit(wrist - elbow))
        try:
            return self.context.senses.skin_cover(self.world.look("head"), points_in_map=points).share
        except PerceptionFailure:
            return 0.0  # out of the picture

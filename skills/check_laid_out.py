"""Stage C: whether arm and sleeve lie so that a try to dress the arm can begin, after one that failed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.errors import PerceptionFailure
from ..sim.world import Side
from .belief.person_tracking import PERSON_TRACKING, visible_share, watch_arm
from .belief.sleeve_search import find_sleeve
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill

AT_HAND = 0.36  # how far from the fingertips, along the bed, a sleeve lies at most that is taken from there [m]


class CheckLaidOut(Skill):
    """Looks whether the arm shows where it was seen last, and whether its sleeve lies by the hand.

    A sleeve that does not show is let pass.

    Inputs: `side` of the person.
    """

    commands = False
    side = Input(Side)
    reasons = (Reason.ARM_LOST, Reason.ARM_COVERED, Reason.SLEEVE_MISSED)

    def steps(self) -> Iterator[None]:
        """One look."""
        posture = watch_arm(self, self.side)
        share = visible_share(self.world.look("head"), posture)
        self.note(f"{share:.0%} of the {self.side} arm show")
        if share < PERSON_TRACKING.min_visible:
            raise SkillFailure(Reason.ARM_COVERED, f"{share:.0%} of it show")
        try:
            sleeve = find_sleeve(self, self.side, posture.points_in_map)
        except PerceptionFailure:
            return
        away = float(np.linalg.norm((sleeve.position_in_map - posture.points_in_map[3])[:2]))
        if away > AT_HAND:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"it lies {away * 100:.0f} cm from the hand")
        yield

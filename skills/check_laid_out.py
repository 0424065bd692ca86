"""Check, after a failed attempt to dress an arm, whether arm and sleeve lie ready for the next one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import Side
from .belief.person_tracking import PERSON_TRACKING, visible_share, watch_arm
from .belief.refused_stands import REFUSED, refused_stands
from .belief.sleeve_search import find_sleeve
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill


@dataclass(frozen=True, kw_only=True)
class CheckLaidOutTuning(Quantities):
    """Numbers of `CheckLaidOut`."""

    max_distance: float = quantity(
        0.36, "m", "from the fingertips to the sleeve, in the plane of the bed", "choice: it is taken from there"
    )


class CheckLaidOut(Skill):
    """Looks whether the arm shows where it was seen last, and whether its sleeve lies by the hand.

    It fails where the arm is covered or not known well, where the sleeve lies elsewhere or does not show, and where it
    was missed or out of reach from more than one stand.
    """

    commands = False
    side = Input(Side, doc="the person's side")
    tuning = Input(CheckLaidOutTuning, default=CheckLaidOutTuning(), doc="numbers of this skill")
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.ARM_COVERED, Reason.SLEEVE_MISSED)

    def steps(self) -> Iterator[None]:
        """One look."""
        posture = watch_arm(self, self.side)
        off = float(posture.deviation.max())
        if off > PERSON_TRACKING.sure_deviation:
            # half under its sleeve it showed where it was believed to be, and was looked for in vain six times (0)
            raise SkillFailure(Reason.ARM_LOST, f"a joint of it is known to {off * 100:.0f} cm")
        share = visible_share(self.world.look("head"), posture)
        self.note(f"{share:.0%} of the {self.side} arm show")
        if share < PERSON_TRACKING.min_visible:
            raise SkillFailure(Reason.ARM_COVERED, f"{share:.0%} of it show")
        sleeve = find_sleeve(self, self.side, posture.points_in_map)
        away = float(np.linalg.norm((sleeve.position_in_map - posture.points_in_map[3])[:2]))
        if away > self.tuning.max_distance:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"it lies {away * 100:.0f} cm from the hand")
        if (refused := len(refused_stands(self, self.side))) >= REFUSED:
            raise SkillFailure(Reason.SLEEVE_MISSED, f"it was not taken from {refused} stands")
        yield

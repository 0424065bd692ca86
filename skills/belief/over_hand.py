"""Whether a sleeve is over the hand, past the wrist, by what shows of it along the forearm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...perception.errors import PerceptionFailure
from ...perception.image.cloud import unit
from ...perception.senses import Senses
from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side


@dataclass(frozen=True, kw_only=True)
class OverHandTuning(Quantities):
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


@dataclass(frozen=True, kw_only=True)
class OnForearm:
    """A sleeve along a forearm.

    Attributes:
        armhole_at, cuff_at: where its bindings show: 0 elbow, 1 wrist.
        round_arm: share of the way round the arm that its cuff shows.
        covered: share of the arm's axis between them that shows something else than skin; 0 out of the picture.
    """

    armhole_at: float
    cuff_at: float
    round_arm: float
    covered: float

    def over_hand(self, tuning: OverHandTuning) -> bool:
        """Whether it is past the wrist, round the arm."""
        past_wrist = self.armhole_at < tuning.max_armhole_at and self.cuff_at > self.armhole_at + tuning.min_length
        return past_wrist and self.round_arm >= tuning.min_round and self.covered >= tuning.min_covered


def on_forearm(senses: Senses, frame: Frame, side: Side, arm_in_map: np.ndarray, points: int) -> OnForearm:
    """What a picture shows of a sleeve along a forearm.

    Args:
        senses: that see it.
        frame: that may show it.
        side: of the person.
        arm_in_map: (4, 3) shoulder, elbow, wrist, fingertip [m].
        points: along the arm's axis that are looked at.

    Raises:
        PerceptionFailure: one of its bindings does not show there.
    """
    seen = senses.sleeve_on_forearm(frame, side=side, arm_in_map=arm_in_map)
    shoulder, elbow, wrist, _ = arm_in_map
    along = np.linspace(seen.armhole_at, min(seen.cuff_at, 1.0), points)[:, None] * np.linalg.norm(wrist - elbow)
    axis = elbow + np.where(along < 0.0, along * unit(elbow - shoulder), along * unit(wrist - elbow))
    try:
        covered = senses.skin_cover(frame, points_in_map=axis).share
    except PerceptionFailure:
        covered = 0.0
    return OnForearm(armhole_at=seen.armhole_at, cuff_at=seen.cuff_at, round_arm=seen.round_arm, covered=covered)

"""Whether a hand is inside its sleeve before anybody has drawn it there, as far as it shows."""

import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover, WornSleeve
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.arm_path import ArmPath
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_over_hand import CheckOverHand

from ....skills.bench import LeafBench, beside_bed

HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "bindings")
AWAY = PerceptionFailure(Problem.OUT_OF_REACH, "forearm")


def on_forearm(armhole_at, cuff_at, round_arm):
    return WornSleeve(
        stamp=0.0, confidence=0.9, side="left", armhole_at=armhole_at, cuff_at=cuff_at, reach=0.0, round_arm=round_arm
    )


def covered(share):
    return Cover(stamp=0.0, confidence=0.9, share=share)


@pytest.mark.parametrize(
    ("sleeve", "cover", "reason"),
    [
        (on_forearm(0.65, 1.18, 0.83), covered(1.0), None),  # as seed 0 had it, the armhole past the wrist
        (on_forearm(-0.14, 0.38, 0.92), covered(1.0), None),  # the armhole at the elbow
        (on_forearm(1.4, 2.0, 0.5), covered(1.0), Reason.SLEEVE_MISSED),  # before the hand
        (on_forearm(0.45, 1.09, 0.58), covered(0.0), Reason.SLEEVE_MISSED),  # the arm lies on it (138)
        (on_forearm(0.45, 1.09, 0.25), covered(1.0), Reason.SLEEVE_MISSED),  # beside the arm
        (on_forearm(0.6, 0.4, 0.7), covered(1.0), Reason.SLEEVE_MISSED),  # the cuff first
        (on_forearm(0.65, 1.18, 0.83), AWAY, Reason.SLEEVE_MISSED),
        (HIDDEN, covered(1.0), Reason.SLEEVE_MISSED),
    ],
)
def test_only_a_sleeve_round_the_forearm_that_covers_it_is_over_the_hand(sleeve, cover, reason):
    senses = beside_bed(sleeve_on_forearm=sleeve, skin_cover=cover, arm=lying_posture("left"))
    assert LeafBench(lambda context: CheckOverHand("over", context, side="left"), senses).ended(seconds=1.0) == reason


@pytest.mark.parametrize(("armhole_at", "cuff_at", "first", "last"), [(0.5, 1.4, 1.5, 2.0), (-0.5, 0.5, 0.5, 1.5)])
def test_it_looks_at_the_arm_between_armhole_and_cuff(armhole_at, cuff_at, first, last):
    asked, arm = [], lying_posture("left")

    def skin_cover(frame, points_in_map):
        asked.append(points_in_map)
        return covered(1.0)

    senses = beside_bed(sleeve_on_forearm=on_forearm(armhole_at, cuff_at, 0.8), skin_cover=skin_cover, arm=arm)
    LeafBench(lambda context: CheckOverHand("over", context, side="left"), senses).ended(seconds=1.0)
    path = ArmPath.of(arm)
    assert asked[0][0] == pytest.approx(path.point(first), abs=0.03)
    assert asked[0][-1] == pytest.approx(path.point(last), abs=0.03)

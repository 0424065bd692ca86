"""Whether a try to dress an arm can begin again."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.belief.refused_stands import refused_stands
from caretree.skills.check_laid_out import CheckLaidOut
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from .bench import LeafBench, beside_bed

FARTHEST = 0.36  # from the fingertips to a sleeve that is taken from there [m]


def away(distance):
    """A sleeve so far from the fingertips, towards the head."""
    place = lying_posture("left").points_in_map[3] + distance * np.array((0.0, -1.0, 0.0))
    return replace(laid_strap("left"), position_in_map=place)


@pytest.mark.parametrize(
    ("sleeve", "share", "reason"),
    [
        (away(FARTHEST - 0.02), 1.0, None),
        (away(FARTHEST + 0.02), 1.0, Reason.SLEEVE_MISSED),
        (away(0.1), 0.5, Reason.ARM_COVERED),
        (PerceptionFailure(Problem.NOTHING_SEEN, "sleeve"), 1.0, Reason.NOTHING_SEEN),
    ],
)
def test_the_arm_has_to_be_bare_and_the_sleeve_at_hand(monkeypatch, sleeve, share, reason):
    monkeypatch.setattr("caretree.skills.check_laid_out.visible_share", lambda frame, posture: share)
    monkeypatch.setattr("caretree.skills.belief.person_tracking.visible_share", lambda frame, posture: 1.0)
    run = LeafBench(
        lambda context: CheckLaidOut("laid out", context, side="left"),
        beside_bed(sleeve_opening=sleeve, arm=lying_posture("left")),
    )
    assert run.ended(seconds=1.0) == reason


@pytest.mark.parametrize(("deviation", "reason"), [(0.03, None), (0.04, Reason.ARM_LOST)])
def test_an_arm_that_is_not_known_well_is_not_laid_out(monkeypatch, deviation, reason):
    monkeypatch.setattr("caretree.skills.check_laid_out.visible_share", lambda frame, posture: 1.0)
    monkeypatch.setattr("caretree.skills.belief.person_tracking.visible_share", lambda frame, posture: 1.0)
    known = replace(lying_posture("left"), deviation=np.full(4, deviation))
    run = LeafBench(
        lambda context: CheckLaidOut("laid out", context, side="left"), beside_bed(sleeve_opening=away(0.1), arm=known)
    )
    assert run.ended(seconds=1.0) == reason


@pytest.mark.parametrize(("stands", "reason"), [(1, None), (2, Reason.SLEEVE_MISSED)])
def test_a_sleeve_that_was_out_of_reach_from_two_stands_is_at_no_hand(monkeypatch, stands, reason):
    monkeypatch.setattr("caretree.skills.check_laid_out.visible_share", lambda frame, posture: 1.0)
    monkeypatch.setattr("caretree.skills.belief.person_tracking.visible_share", lambda frame, posture: 1.0)

    def leaf(context):
        skill = CheckLaidOut("laid out", context, side="left")
        refused_stands(skill, "left").extend([np.zeros(3)] * stands)
        return skill

    world = beside_bed(sleeve_opening=away(0.1), arm=lying_posture("left"))
    assert LeafBench(leaf, world).ended(seconds=1.0) == reason

"""Whether the collar lies in the middle between the shoulders, as far as it shows."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GraspPoint
from caretree.skills.belief.close_look import CloseLook
from caretree.skills.belief.shoulders import COLLAR_SEEN
from caretree.skills.core.reasons import Reason
from caretree.skills.scripted.scripted_person import lying_posture
from caretree.trees.tasks.dressing.check_collar import CheckCollar, CheckCollarTuning
from py_trees.common import Status

from ....skills.bench import LeafBench, beside_bed

MIDDLE = np.mean([lying_posture(side).points_in_map[0] for side in ("left", "right")], axis=0)  # of the shoulders [m]


def collar(aside, headward=0.0):
    """A collar whose middle lies so far off the middle between the shoulders [m]; y is towards the feet."""
    return GraspPoint(
        stamp=0.0,
        confidence=0.9,
        target="collar_middle",
        position_in_map=MIDDLE + (aside + COLLAR_SEEN.aside, -headward, 0.1),
        approach_in_map=np.array((0.0, 0.0, -1.0)),
        closing_in_map=np.array((0.0, 1.0, 0.0)),
    )


@pytest.mark.parametrize(
    ("seen", "reason"),
    [
        (collar(0.0, 0.0), None),
        (collar(-0.05, 0.08), None),
        (collar(0.09, 0.0), Reason.COLLAR_ASIDE),
        (collar(-0.09, 0.0), Reason.COLLAR_ASIDE),
        (collar(0.0, 0.12), Reason.COLLAR_ASIDE),
        (collar(0.0, 0.09), None),
        (collar(0.0, -0.07), None),
        (collar(0.0, -0.09), Reason.COLLAR_ASIDE),
        (PerceptionFailure(Problem.NOTHING_SEEN, "neck binding"), Reason.NOTHING_SEEN),
    ],
)
def test_a_collar_off_its_place_or_unseen_is_no_success(seen, reason):
    run = LeafBench(
        lambda context: CheckCollar("lies well", context),
        beside_bed(collar_middle=seen, arm=lambda frame, side, **_: lying_posture(side)),
    )
    assert run.ended(seconds=1.0) == reason
    assert run.skill.status == (Status.SUCCESS if reason is None else Status.FAILURE)


@pytest.mark.parametrize(
    ("aside", "closely", "reason"),
    [
        (0.04, True, Reason.COLLAR_ASIDE),
        (-0.04, True, Reason.COLLAR_ASIDE),
        (0.02, True, Reason.NOTHING_SEEN),
        (0.04, False, Reason.NOTHING_SEEN),
    ],
)
def test_one_that_both_hands_see_aside_lies_there_however_little_of_it_tells(aside, closely, reason):
    seen = replace(collar(aside), confidence=0.5)
    run = LeafBench(
        lambda context: CheckCollar("lies well", context, tuning=CheckCollarTuning(min_shown=0.7, min_told=0.8)),
        beside_bed(collar_middle=seen, arm=lambda frame, side, **_: lying_posture(side)),
    )
    if closely:
        CloseLook.of(run.skill).seen = seen
    assert run.ended(seconds=1.0) == reason


@pytest.mark.parametrize(
    ("shown", "closely", "reason"),
    [
        (0.96, False, None),
        (0.9, False, Reason.COLLAR_ASIDE),
        (0.9, True, None),
        (0.8, True, Reason.COLLAR_ASIDE),
        (0.6, True, Reason.NOTHING_SEEN),
        (0.6, False, Reason.NOTHING_SEEN),
    ],
)
def test_of_a_collar_that_is_looked_at_from_the_head_more_has_to_show_than_closely(shown, closely, reason):
    seen = replace(collar(0.0), confidence=shown)
    tuning = CheckCollarTuning(min_shown=0.7, min_told=0.88, min_told_from_head=0.95)
    run = LeafBench(
        lambda context: CheckCollar("lies well", context, tuning=tuning),
        beside_bed(collar_middle=seen, arm=lambda frame, side, **_: lying_posture(side)),
    )
    if closely:
        CloseLook.of(run.skill).seen = seen
    assert run.ended(seconds=1.0) == reason

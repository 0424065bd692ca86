"""Whether the collar lies in the middle between the shoulders, as far as it shows."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GraspPoint
from caretree.skills.belief.shoulders import COLLAR_SEEN
from caretree.skills.core.ports import Key
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
    ("before", "seen", "reason"),
    [
        ((0.03, 0.09), collar(0.0), None),
        ((0.03, 0.09), collar(0.06), Reason.COLLAR_ASIDE),
        ((-0.03, -0.09), collar(-0.06), Reason.COLLAR_ASIDE),
        ((0.09,), collar(-0.03), None),
        ((0.0, 0.0), collar(0.0, headward=0.12), Reason.COLLAR_ASIDE),
        ((0.0, 0.0), PerceptionFailure(Problem.NOTHING_SEEN, "neck binding"), None),
        ((0.0,), PerceptionFailure(Problem.NOTHING_SEEN, "neck binding"), Reason.NOTHING_SEEN),
        ((), collar(0.0), Reason.NOTHING_SEEN),
    ],
)
def test_seen_from_several_places_it_counts_on_average(before, seen, reason):
    tuning = CheckCollarTuning(min_looks=2, max_aside=0.045)
    run = LeafBench(
        lambda context: CheckCollar("lies well", context, before=before, tuning=tuning),
        beside_bed(collar_middle=seen, arm=lambda frame, side, **_: lying_posture(side)),
    )
    assert run.ended(seconds=1.0) == reason


@pytest.mark.parametrize(("shown", "looks"), [(0.9, (0.02, 0.12)), (0.6, (0.02,))])
def test_a_look_that_does_not_decide_adds_to_those_before_where_enough_shows(shown, looks):
    run = LeafBench(
        lambda context: CheckCollar(
            "look", context, before=(0.02,), decide=False, tuning=CheckCollarTuning(min_shown=0.7), looks=Key("looks")
        ),
        beside_bed(
            collar_middle=replace(collar(0.12), confidence=shown), arm=lambda frame, side, **_: lying_posture(side)
        ),
    )
    assert run.ended(seconds=1.0) is None
    assert run.context.board.get("looks") == pytest.approx(looks)

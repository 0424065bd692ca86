"""Whether an arm is inside its sleeve, as far as it shows."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Cover, WornSleeve
from caretree.skills.belief.close_look import CloseLook, SleeveSeen
from caretree.skills.belief.pulled_sleeves import pull_loads
from caretree.skills.check_sleeve import CheckSleeve
from caretree.skills.core.reasons import Reason
from caretree.skills.geometry.stances import outwards
from caretree.skills.scripted.scripted_person import lying_posture
from py_trees.common import Status

from .bench import LeafBench, beside_bed


def worn(cuff_at=0.5, reach=0.8, **seen):
    shows = {"side": "left", "armhole_at": 0.2, "round_arm": 0.7, "inside_out": 0.1} | seen
    return WornSleeve(stamp=0.0, confidence=0.9, cuff_at=cuff_at, reach=reach, **shows)


HIDDEN = PerceptionFailure(Problem.NOTHING_SEEN, "bindings")


def ran(seen, covered=1.0, **options):
    """The skill after one run; `covered` is how much of the upper arm shows no skin."""
    cover = covered if isinstance(covered, Exception) else Cover(stamp=0.0, confidence=1.0, share=covered)
    run = LeafBench(
        lambda context: CheckSleeve("inside", context, side="left", **options),
        beside_bed(worn_sleeve=seen, arm=lying_posture("left"), skin_cover=cover),
    )
    run.ended(seconds=1.0)
    return run.skill


@pytest.mark.parametrize(
    ("seen", "min_reach", "status", "reason"),
    [
        (worn(), None, Status.SUCCESS, None),
        (worn(cuff_at=0.03), None, Status.FAILURE, Reason.SLEEVE_MISSED),
        (worn(cuff_at=0.29), None, Status.SUCCESS, None),
        (worn(round_arm=0.2), None, Status.FAILURE, Reason.SLEEVE_MISSED),
        (worn(round_arm=5 / 12), None, Status.FAILURE, Reason.SLEEVE_MISSED),
        (worn(round_arm=6 / 12), None, Status.SUCCESS, None),
        (worn(cuff_at=0.9), None, Status.SUCCESS, None),
        (worn(reach=0.71), 0.70, Status.SUCCESS, None),
        (worn(reach=0.69), 0.70, Status.FAILURE, Reason.SLEEVE_LOW),
        (HIDDEN, 0.70, Status.SUCCESS, None),
    ],
)
def test_a_heap_at_the_shoulder_or_beside_the_arm_is_a_miss_and_an_armhole_far_down_is_low(
    seen, min_reach, status, reason
):
    skill = ran(seen, **({} if min_reach is None else {"min_reach": min_reach}))
    assert skill.status == status
    assert (skill.failure and skill.failure.reason) == reason


@pytest.mark.parametrize(
    ("before", "now", "status"),
    [
        (0.73, 0.69, Status.SUCCESS),  # either alone would not do
        (0.70, 0.69, Status.FAILURE),
        (0.65, 0.78, Status.FAILURE),
        (0.0, 0.78, Status.SUCCESS),  # it did not show before
        (0.0, 0.74, Status.FAILURE),
    ],
)
def test_two_looks_from_different_places_are_told_by_their_mean(before, now, status):
    skill = ran(worn(reach=now), min_reach=0.75, seen_before=before, min_together=0.71)
    assert skill.status == status
    assert (skill.reach == now) if status == Status.SUCCESS else (skill.failure.reason == Reason.SLEEVE_LOW)


@pytest.mark.parametrize(
    ("load", "reach", "status"),
    [
        (3.5, 0.52, Status.SUCCESS),
        (3.5, 0.40, Status.FAILURE),  # caught, or beside the arm
        (None, 0.52, Status.SUCCESS),  # the pull did not come to its end
        (None, 0.40, Status.FAILURE),
        (1.9, 0.59, Status.FAILURE),  # it came freely, and not far
        (1.9, 0.75, Status.SUCCESS),
        (1.4, 0.81, Status.FAILURE),  # it came freely
    ],
)
def test_a_sleeve_that_was_drawn_up_is_where_a_pull_with_that_load_brings_it(load, reach, status):
    def skill(context):
        pull_loads(context).update({} if load is None else {"left": load})
        return CheckSleeve("inside", context, side="left", pulled=True)

    covered = Cover(stamp=0.0, confidence=1.0, share=1.0)
    run = LeafBench(skill, beside_bed(worn_sleeve=worn(reach=reach), arm=lying_posture("left"), skin_cover=covered))
    run.ended(seconds=1.0)
    assert run.skill.status == status
    missed = Reason.SLEEVE_MISSED if load == 1.4 else Reason.SLEEVE_LOW
    assert status == Status.SUCCESS or run.skill.failure.reason == missed
    assert ran(worn(reach=reach)).status == Status.SUCCESS, "of one that nobody has drawn up just now nothing is asked"


@pytest.mark.parametrize(
    ("inside_out", "pulled", "status"),
    [(0.6, True, Status.SUCCESS), (0.9, True, Status.FAILURE), (0.9, False, Status.SUCCESS)],
)
def test_a_sleeve_that_was_drawn_up_and_shows_its_inside_has_no_arm_in_it(inside_out, pulled, status):
    skill = ran(worn(inside_out=inside_out), pulled=pulled)
    assert skill.status == status
    assert status == Status.SUCCESS or skill.failure.reason == Reason.SLEEVE_MISSED


def test_a_sleeve_that_does_not_show_counts_as_not_seen():
    assert ran(HIDDEN).reach == 0.0


def test_one_that_must_show_is_not_let_pass_unseen():
    skill = ran(HIDDEN, min_reach=0.70, must_show=True)
    assert (skill.status, skill.failure.reason) == (Status.FAILURE, Reason.NOTHING_SEEN)
    assert ran(worn(), min_reach=0.70, must_show=True).status == Status.SUCCESS


def test_an_upper_arm_that_shows_bare_is_in_no_sleeve_whatever_hides_its_bindings():
    skill = ran(HIDDEN, covered=0.1)
    assert (skill.status, skill.failure.reason) == (Status.FAILURE, Reason.SLEEVE_MISSED)
    assert ran(HIDDEN, covered=0.5).status == Status.SUCCESS
    assert ran(HIDDEN, covered=PerceptionFailure(Problem.OUT_OF_REACH, "arm")).status == Status.SUCCESS


@pytest.mark.parametrize(("covered", "status"), [(1.0, Status.SUCCESS), (0.6, Status.SUCCESS), (0.33, Status.FAILURE)])
def test_a_sleeve_that_lies_along_its_arm_leaves_the_outer_side_bare(covered, status):
    skill = ran(worn(), covered=covered)
    assert skill.status == status
    assert skill.failure is None or skill.failure.reason == Reason.SLEEVE_MISSED


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_outer_side_is_looked_at_between_the_bindings_away_from_the_body(side):
    asked = []

    def cover(frame, points_in_map):
        asked.append(points_in_map)
        return Cover(stamp=0.0, confidence=1.0, share=1.0)

    posture = lying_posture(side)
    seen = replace(worn(), side=side)
    run = LeafBench(
        lambda context: CheckSleeve("inside", context, side=side),
        beside_bed(worn_sleeve=seen, arm=lambda frame, side, **_: lying_posture(side), skin_cover=cover),
    )
    run.ended(seconds=1.0)
    shoulder, elbow = posture.points_in_map[:2]
    upper = elbow - shoulder
    along = (asked[-1] - shoulder) @ upper / (upper @ upper)
    assert 0.2 < along.min() < along.max() < 0.5
    off = asked[-1] - shoulder - along[:, None] * upper
    assert np.linalg.norm(off, axis=1) == pytest.approx(0.035)
    assert np.all(off @ outwards(side) > 0.02)


@pytest.mark.parametrize(("now", "status"), [(0.71, Status.SUCCESS), (0.69, Status.FAILURE)])
def test_a_look_that_tells_too_little_is_low_whatever_was_seen_before(now, status):
    skill = ran(worn(reach=now), seen_before=0.9, min_together=0.71, min_now=0.70)
    assert skill.status == status
    assert (skill.failure and skill.failure.reason) == (Reason.SLEEVE_LOW if status == Status.FAILURE else None)


@pytest.mark.parametrize(
    ("seen", "closely", "round_arm", "status"),
    [
        (worn(reach=0.5), 0.75, 0.9, Status.SUCCESS),
        (worn(reach=0.9), 0.65, 0.9, Status.FAILURE),
        (HIDDEN, 0.75, 0.9, Status.SUCCESS),
        (HIDDEN, 0.65, 0.9, Status.FAILURE),
        (worn(round_arm=0.4), 0.75, 0.6, Status.SUCCESS),
        (worn(round_arm=0.4), 0.75, 0.5, Status.FAILURE),
        (worn(round_arm=0.5), 0.75, 0.2, Status.SUCCESS),
        (worn(cuff_at=0.05), 0.75, 0.9, Status.SUCCESS),
        (worn(cuff_at=0.05), 0.75, 0.5, Status.FAILURE),
    ],
)
def test_a_close_look_tells_how_far_up_it_is_and_either_whether_the_arm_is_inside(seen, closely, round_arm, status):
    run = LeafBench(
        lambda context: CheckSleeve(
            "inside", context, side="left", min_reach=0.73, min_now=0.73, min_closely=0.71, must_show=True
        ),
        beside_bed(worn_sleeve=seen, arm=lying_posture("left"), skin_cover=Cover(stamp=0.0, confidence=1.0, share=1.0)),
    )
    CloseLook.of(run.skill).sleeves["left"] = SleeveSeen(closely, round_arm, run.skill.now())
    run.ended(seconds=1.0)
    assert run.skill.status == status
    assert status == Status.FAILURE or run.skill.reach == closely


@pytest.mark.parametrize(("reach", "status"), [(0.75, Status.SUCCESS), (0.30, Status.FAILURE)])
def test_where_no_close_look_is_asked_for_this_look_alone_tells(reach, status):
    run = LeafBench(
        lambda context: CheckSleeve("inside", context, side="left", min_reach=0.4),
        beside_bed(
            worn_sleeve=worn(reach=reach),
            arm=lying_posture("left"),
            skin_cover=Cover(stamp=0.0, confidence=1.0, share=1.0),
        ),
    )
    CloseLook.of(run.skill).sleeves["left"] = SleeveSeen(0.35, 0.9, run.skill.now())
    run.ended(seconds=1.0)
    assert run.skill.status == status

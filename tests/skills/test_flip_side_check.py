"""Which side of the gown faces the robot is voted on by a few frames."""

import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GownSide
from caretree.skills.core.reasons import Reason
from caretree.skills.flip_side_check import FlipSideCheck

from .hung_gown import bench_with, ended


def side(outside, confidence=0.9):
    return GownSide(stamp=0.0, confidence=confidence, outside=outside)


OUTSIDE, INSIDE = side(True), side(False)


def bench(seen, **ports):
    return bench_with(lambda context: FlipSideCheck("outside", context, **ports), gown_side=seen)


def test_the_outside_is_well_and_nothing_moves():
    run = bench(OUTSIDE)
    assert ended(run) is None
    assert run.skill.seen.outside
    assert run.sent == 0


def test_the_inside_is_the_wrong_side():
    assert ended(bench(INSIDE)) == Reason.WRONG_SIDE


@pytest.mark.parametrize(
    ("frames", "reason"),
    [([INSIDE, INSIDE, OUTSIDE], Reason.WRONG_SIDE), ([OUTSIDE, OUTSIDE, INSIDE], None)],
    ids=["two of three show the inside", "one of three does"],
)
def test_most_frames_win(frames, reason):
    assert ended(bench(frames)) == reason


def test_a_doubtful_sight_of_the_inside_does_not_count():
    assert ended(bench(side(False, confidence=0.4), min_confidence=0.5)) is None
    assert ended(bench(side(False, confidence=0.6), min_confidence=0.5)) == Reason.WRONG_SIDE


def test_a_gown_on_its_hook_is_judged_by_what_hangs_below_the_hook():
    run = bench_with(lambda context: FlipSideCheck("outside", context, hung=True), hung_side=INSIDE, gown_side=OUTSIDE)
    assert ended(run) == Reason.WRONG_SIDE


def test_no_gown_in_view_is_told():
    assert ended(bench(PerceptionFailure(Problem.NOTHING_SEEN, "fabric"))) == Reason.NOTHING_SEEN

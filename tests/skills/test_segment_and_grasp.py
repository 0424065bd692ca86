"""The gown on its rail is looked for, stood before and taken near its hook."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Estimate
from caretree.skills.core.reasons import Reason
from caretree.skills.segment_and_grasp import SegmentAndGrasp

from .hung_gown import STAND, at, bench_with, ended, hand_from_base, seen_at

FAR = at(1.60, 0.10, 1.20)  # beyond the reach from where the robot stands
CLOTH, NOTHING = Estimate(stamp=0.0, confidence=0.9), Estimate(stamp=0.0, confidence=0.0)


def bench(shown, between=CLOTH):
    """The hand on the right takes the gown; `between` is what its camera sees between the closed fingers."""
    return bench_with(
        lambda context: SegmentAndGrasp("take", context, hand="right"), hang_point=shown, gripped_cloth=between
    )


def test_closes_around_the_place_that_shows():
    run = bench(seen_at(FAR))
    assert ended(run) is None
    place, _ = run.world.closed["right"]
    assert np.linalg.norm(place - FAR) < 0.025  # [m]: the fingertips are a little beyond the cloth's edge
    assert "left" not in run.world.closed
    assert run.skill.grasp.position_in_map == pytest.approx(FAR)


def test_stands_where_the_hand_works_with_ease():
    run = bench(seen_at(FAR))
    assert ended(run) is None
    ahead, left, _ = hand_from_base(run.world, "right")
    assert 0.8 < ahead < 1.1  # [m]
    assert -0.4 < left < -0.1  # [m]: to the hand's own side
    assert run.world.observe().pose_base_in_map[2] == pytest.approx(STAND[2], abs=0.03)  # [rad]


def test_a_hand_that_closed_on_nothing_opens_and_draws_back():
    run = bench(seen_at(FAR), between=NOTHING)
    assert ended(run) == Reason.GRASP_MISSED
    assert np.linalg.norm(run.world.hand("right")[:3, 3] - FAR) > 0.09  # [m]
    assert run.world.observe().gripper_opening[1] > 0.07  # [m]


def test_no_gown_in_view_is_told_from_where_the_robot_stands():
    run = bench(PerceptionFailure(Problem.NOTHING_SEEN, "a gown"))
    assert ended(run) == Reason.NOTHING_SEEN
    assert run.world.observe().pose_base_in_map == pytest.approx(STAND)

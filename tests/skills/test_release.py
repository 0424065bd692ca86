"""A hand lets go before it draws back, and draws back less where it cannot go as far."""

import numpy as np
import pytest
from caretree.sim.world import GripperOpening
from caretree.skills.core.reasons import Reason
from caretree.skills.release import Release

from .bench import CLOTH, LeafBench, beside_bed


def bench(distance=0.15, **options):
    """The right hand, in its ready posture, holds cloth."""
    return LeafBench(
        lambda context: Release("release", context, hand="right", distance=distance),
        beside_bed(held={"right": CLOTH, "left": CLOTH}, **options),
    )


def drawn_back(run):
    """Way (3,) of the right hand in its own frame, the last axis the way it pointed [m]."""
    start = run.start.pose_hand_in_map[1]
    return start[:3, :3].T @ (run.way("right")[-1] - start[:3, 3])


def test_the_fingers_open_and_then_the_hand_draws_back_the_way_it_points():
    run = bench()
    assert run.ended() is None
    assert drawn_back(run) == pytest.approx((0.0, 0.0, -0.15), abs=0.02)
    opened = int(np.argmax(run.openings("right") > 0.075))
    moved = np.linalg.norm(run.way("right") - run.way("right")[0], axis=1)
    assert opened > 0
    assert moved[:opened].max() < 0.005, "it stands until the fingers are open"
    assert run.openings("right")[-1] > 0.08
    assert run.openings("left").max() < 0.01, "the other hand keeps what it holds"
    assert run.way("left")[-1] == pytest.approx(run.way("left")[0], abs=0.005)


def test_a_hand_that_cannot_go_as_far_goes_a_part_of_it():
    run = bench(distance=1.2)
    assert run.ended() is None
    back = -drawn_back(run)[2]
    assert min(abs(back - part) for part in (0.3, 0.6)) < 0.03  # [m], a half or a quarter


def test_one_that_cannot_draw_back_at_all_has_let_go_all_the_same():
    run = bench(distance=8.0)
    assert run.ended() is None
    assert run.openings("right")[-1] > 0.08
    assert drawn_back(run) == pytest.approx(np.zeros(3), abs=0.005)


def test_fingers_that_do_not_open_are_told_and_the_hand_stays():
    run = bench(deaf_to=(GripperOpening,))
    assert run.ended() == Reason.COMMAND_LOST
    assert drawn_back(run) == pytest.approx(np.zeros(3), abs=0.005)

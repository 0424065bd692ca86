"""The gown in one hand is turned before the head camera and looked at from all sides."""

import numpy as np
import pytest
from caretree.skills.core.reasons import Reason
from caretree.skills.view_around import ViewAround

from .hung_gown import bench_with, ended


def bench(hand="right", **ports):
    return bench_with(lambda context: ViewAround("view", context, hand=hand, **ports))


def yaw(pose):
    """Of a hand that points down, about the vertical [rad]."""
    return np.arctan2(pose[1, 1], pose[0, 1])


@pytest.mark.parametrize("hand", ["left", "right"])
def test_one_view_for_each_30_degrees(hand):
    run = bench(hand)
    assert ended(run) is None
    views = run.skill.views
    assert views.hand == hand
    assert len(views.frames) == len(views.poses_hand_in_map) == 11
    turns = np.diff(np.unwrap([yaw(pose) for pose in views.poses_hand_in_map]))
    assert np.abs(turns) == pytest.approx(np.full(10, np.deg2rad(30.0)), abs=np.deg2rad(6.0))
    assert np.ptp(np.sign(turns)) == 0  # one way round
    stamps = [frame.stamp for frame in views.frames]
    assert stamps == sorted(set(stamps))


def test_the_hand_turns_where_it_is_before_the_camera():
    run = bench()
    assert ended(run) is None
    poses = np.array(run.skill.views.poses_hand_in_map)
    assert np.ptp(poses[:, :3, 3], axis=0).max() < 0.03  # [m]
    assert (poses[:, 2, 2] < -0.95).all()  # the hand points down: what hangs from it is seen below the arm


def test_the_cloth_swings_out_before_the_first_view():
    def first(settle):
        run = bench(count=3, settle=settle)
        assert ended(run) is None
        return run.skill.views.frames[0].stamp

    assert first(1.5) - first(0.5) == pytest.approx(1.0, abs=0.15)  # [s]


def test_a_hand_that_stops_on_the_way_is_told():
    run = bench()

    def stop_in_the_turn():
        if run.world.clock.now() > 8.0:  # [s]
            run.world.stop()

    assert ended(run, each_tick=stop_in_the_turn) == Reason.MOTION_BLOCKED
    assert "views" in run.skill.failure.detail

from itertools import pairwise

import numpy as np
import pytest
from caretree.sim.world import RoomMap
from caretree.skills.motion.errors import PathBlocked
from caretree.skills.motion.path import is_free, path_length, plan_path

BED = np.array(((-0.45, -1.0, 0.0), (0.45, 1.0, 0.6)))


def room(wall=False):
    """5 x 6 m with the bed in the middle, inflated by 0.35 m; with `wall`, the foot end touches the wall."""
    resolution = 0.05
    xs, ys = np.arange(-2.5, 2.501, resolution), np.arange(-3.0, 3.001, resolution)
    X, Y = np.meshgrid(xs, ys)
    free = ~((np.abs(X) < 0.45 + 0.35) & (np.abs(Y) < 1.35))
    free &= (np.abs(X) < 2.1) & (np.abs(Y) < 2.6)
    if wall:
        free &= ~((np.abs(X) < 0.6) & (np.abs(Y) > 1.0))
    return RoomMap(free=free, origin=np.array((-2.5, -3.0)), resolution=resolution, bed=BED)


def test_the_path_goes_round_the_bed_and_is_straightened():
    path = plan_path(room(), np.array((1.2, 0.0, 3.0)), np.array((-1.2, 0.3)))
    np.testing.assert_allclose(path[[0, -1]], ((1.2, 0.0), (-1.2, 0.3)))
    for a, b in pairwise(path):
        assert all(is_free(room(), point) for point in np.linspace(a, b, 100))
    assert 3 <= len(path) <= 8
    assert path_length(path) < 5.0  # the shortest way round is 4.4 m


def test_a_free_line_of_sight_is_one_segment():
    assert len(plan_path(room(), np.array((1.2, -2.0)), np.array((1.2, 2.0)))) == 2


def test_a_base_half_under_the_bed_backs_out_first():
    path = plan_path(room(), np.array((0.7, 0.0)), np.array((1.3, 1.5)))
    np.testing.assert_allclose(path[0], (0.7, 0.0))
    assert 0.75 <= path[1, 0] <= 0.95
    assert abs(path[1, 1]) < 0.1


@pytest.mark.parametrize(
    ("start", "goal", "message"),
    [
        ((1.2, 0.0), (0.0, 0.0), "obstacle"),
        ((1.2, 0.0), (9.0, 0.0), "obstacle"),
        ((0.0, 0.0), (1.2, 0.0), "any free space"),
    ],
)
def test_impossible_goals_are_told_in_one_sentence(start, goal, message):
    with pytest.raises(PathBlocked, match=message):
        plan_path(room(), np.array(start), np.array(goal))


def test_walled_off_means_no_way():
    with pytest.raises(PathBlocked, match="no free way"):
        plan_path(room(wall=True), np.array((1.2, 0.0)), np.array((-1.2, 0.0)))

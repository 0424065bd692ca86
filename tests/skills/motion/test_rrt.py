from itertools import pairwise

import numpy as np
import pytest
from caretree.skills.motion.errors import MotionBlocked
from caretree.skills.motion.rrt import connect

LOW, HIGH = -np.ones(2), np.ones(2)


def outside(q):
    """A disc in the middle is not free."""
    return bool(np.linalg.norm(q) > 0.5)


def test_the_way_leads_round_what_is_not_free():
    path = connect(np.array((-0.9, 0.0)), np.array((0.9, 0.0)), LOW, HIGH, outside)
    between = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(path)])
    assert all(outside(q) for q in between)


def test_a_start_that_touches_is_left_by_a_small_step():
    path = connect(np.array((-0.45, 0.0)), np.array((0.9, 0.0)), LOW, HIGH, outside)
    assert np.abs(path[1] - path[0]).max() <= 0.25
    assert all(outside(q) for q in path[1:])


def test_deep_inside_there_is_no_way():
    with pytest.raises(MotionBlocked, match="already touch"):
        connect(np.zeros(2), np.array((0.9, 0.0)), LOW, HIGH, outside)
    with pytest.raises(MotionBlocked, match="goal"):
        connect(np.array((0.9, 0.0)), np.zeros(2), LOW, HIGH, outside)

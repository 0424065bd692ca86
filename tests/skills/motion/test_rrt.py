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


def test_a_start_that_touches_is_left_by_the_way_that_is_allowed_for_it():
    start, goal = np.array((-0.45, 0.0)), np.array((0.9, 0.0))
    path = connect(start, goal, LOW, HIGH, outside, leaving=lambda q: bool(np.linalg.norm(q) >= 0.45 - 1e-9))
    between = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(path)])
    assert np.linalg.norm(between, axis=1).min() > 0.4, "never farther in than where it begins"
    assert len(path) > 2, "the straight way leads through it"


def test_where_start_or_goal_touches_there_is_no_way():
    with pytest.raises(MotionBlocked, match="already touch"):
        connect(np.zeros(2), np.array((0.9, 0.0)), LOW, HIGH, outside)
    with pytest.raises(MotionBlocked, match="goal"):
        connect(np.array((0.9, 0.0)), np.zeros(2), LOW, HIGH, outside, leaving=lambda q: True)

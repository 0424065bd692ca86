"""Play in a gear."""

import numpy as np
import pytest
from caretree.sim.effects.effect import JointMotion
from caretree.sim.effects.joint.backlash import Backlash, distance_since_reversal

T = np.arange(0.0, 4.0, 0.01)
MOTION = JointMotion(
    t=T, q=np.sin(T), dq=np.cos(T), ddq=-np.sin(T), load=2.0 * np.sin(T) + 1.0, measured=2.0 * np.sin(T) + 1.0
)


def test_backlash_starts_at_a_reversal_and_ends_after_the_gap():
    load = Backlash().load(MOTION, {"fraction": 1.0, "width": 0.1})
    free = np.abs(load) > 0.5 * np.abs(MOTION.load)
    turn = np.argmax(MOTION.q)
    assert not free[: turn - 5].any()
    assert free[turn + 5]
    assert not free[np.flatnonzero((T[turn] < T) & (MOTION.q < 0.8))].any() or MOTION.q[free].min() < -0.8


def test_distance_counts_from_the_last_turn():
    q = np.array((0.0, 0.5, 1.0, 0.8, 0.3, 0.7))
    assert distance_since_reversal(q, 0.01) == pytest.approx([np.inf, np.inf, np.inf, 0.2, 0.7, 0.4])


def test_the_farthest_row_is_behind_the_turn_where_the_joint_had_turned_by_then():
    early, late = np.array((0.0, 0.5, 0.9, 1.0, 0.8, 0.3)), np.array((0.0, 0.5, 0.8, 1.0, 0.9, 0.3))
    assert distance_since_reversal(early, 0.01)[3] == 0.0
    assert np.isinf(distance_since_reversal(late, 0.01)[3])


def test_a_tremble_is_no_reversal():
    q = np.array((0.0, 0.5, 0.499, 0.6))
    assert np.isinf(distance_since_reversal(q, 0.01)).all()


def test_the_slow_start_after_a_turn_counts():
    q = np.array((0.0, 0.5, 1.0, 0.999, 0.996, 0.98, 0.9))
    assert distance_since_reversal(q, 0.01)[3:] == pytest.approx([0.001, 0.004, 0.02, 0.1])


def test_a_joint_that_rests_and_goes_on_has_not_turned():
    t = np.arange(0.0, 3.0, 0.01)
    rest = 0.5 + 1e-3 * np.sin(20.0 * t) * ((t > 1.0) & (t < 2.0))  # trembling by a tenth of the gap, and less
    q = np.where(t < 1.0, 0.5 * t, np.where(t < 2.0, rest, 0.5 * (t - 1.0)))
    motion = JointMotion(t=t, q=q, dq=np.gradient(q, t), ddq=0.0 * t, load=1.0 + 0.0 * t, measured=0.0 * t)
    assert np.abs(Backlash().load(motion, {"fraction": 1.0, "width": 0.04})).max() < 1e-3

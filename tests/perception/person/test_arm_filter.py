"""What a filtered arm does between looks, and with what it is told."""

import numpy as np
import pytest
from caretree.perception.person.arm_filter import ArmFilter
from caretree.perception.person.arm_fit import ChainFit

ARM = np.array(((0.2, -0.5, 0.7), (0.35, -0.27, 0.68), (0.42, -0.03, 0.66), (0.46, 0.13, 0.65)))
LENGTHS = np.linalg.norm(np.diff(ARM, axis=0), axis=1)


def fit_of(joints, deviation=0.01):
    return ChainFit(joints=joints, covariance=np.eye(12) * deviation**2, cost=1.0, used=100)


def test_what_may_move_fast_is_soon_uncertain():
    still, moving = ArmFilter(fit_of(ARM), 0.0), ArmFilter(fit_of(ARM), 0.0)
    still.predict(5.0, 0.003)
    moving.predict(5.0, 0.10)
    np.testing.assert_allclose(still.joints, ARM)
    assert still.deviation.max() < 0.03 < 0.1 < moving.deviation.min()


def test_time_does_not_run_backwards():
    state = ArmFilter(fit_of(ARM), 3.0)
    before = state.deviation
    state.predict(1.0, 0.1)
    assert state.time == 3.0
    np.testing.assert_array_equal(state.deviation, before)


def test_a_motion_goes_on_for_a_while_and_dies_out():
    state = ArmFilter(fit_of(ARM), 0.0)
    for k in range(1, 11):
        state.predict(0.1 * k, 0.1)
        state.take_fit(fit_of(ARM + (0.0, 0.0, 0.005 * k), 0.003))
    last = state.joints
    state.predict(2.0, 0.1)
    later = state.joints
    state.predict(9.0, 0.1)
    assert (later - last)[:, 2].min() > 0.005
    np.testing.assert_allclose(state.joints, later, atol=0.002)


def test_a_held_point_far_off_turns_the_whole_arm():
    state = ArmFilter(fit_of(ARM), 0.0)
    raised = ARM[0] + LENGTHS[0] * np.array((0.6, 0.0, 0.8))
    state.turn_to(raised, 1.0)
    np.testing.assert_allclose(state.joints[1], raised, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(np.diff(state.joints, axis=0), axis=1), LENGTHS)
    assert state.deviation[3] > 0.05, "it may have twisted on the way"


def test_a_held_point_near_by_is_left_to_the_measurement():
    state = ArmFilter(fit_of(ARM), 0.0)
    state.turn_to(ARM[1] + (0.0, 0.0, 0.03), 1.0)
    np.testing.assert_array_equal(state.joints, ARM)
    state.take_point(ARM[1] + (0.0, 0.0, 0.03), 1.0, 0.002)
    assert state.joints[1, 2] - ARM[1, 2] == pytest.approx(0.03, abs=0.003)


def test_limbs_keep_their_lengths():
    state = ArmFilter(fit_of(ARM), 0.0)
    state.take_lengths(1.1 * LENGTHS, None)
    sizes = np.linalg.norm(np.diff(state.joints, axis=0), axis=1)
    assert (np.abs(sizes - 1.1 * LENGTHS) < np.abs(LENGTHS - 1.1 * LENGTHS) / 2).all()
    span = float(np.linalg.norm(ARM[2] - ARM[0]))
    bent = ArmFilter(fit_of(ARM), 0.0)
    bent.take_lengths(LENGTHS, span - 0.04)
    assert np.linalg.norm(bent.joints[2] - bent.joints[0]) < span - 0.005


def test_an_arm_elsewhere_surprises_until_a_jump_is_admitted():
    state = ArmFilter(fit_of(ARM), 0.0)
    elsewhere = fit_of(ARM + (0.15, 0.0, 0.0))
    assert state.surprise(fit_of(ARM)) == 0.0
    before = state.surprise(elsewhere)
    state.admit_jump()
    assert state.surprise(elsewhere) < before / 4

"""A base that knows roughly where it stands."""

import numpy as np
import pytest
from caretree.sim.scene.difficulties import SIZES, stream
from caretree.sim.sensors.localisation import Localisation
from caretree.sim.world import HandTwist

SIZE = SIZES.localisation
TIMES = np.arange(0.0, 400.0, 0.5)


def walk(seed):
    located = Localisation(stream(seed, "localisation"))
    return np.array([located.error(time) for time in TIMES])


WALKS = np.array([walk(seed) for seed in range(100, 140)])  # (seeds, times, 3)


def test_errors_stay_within_two_centimetres_and_one_degree_and_use_all_of_it():
    bounds = np.array((0.02, 0.02, np.deg2rad(1.0)))
    share = WALKS / bounds
    assert np.abs(share).max() <= 1.0
    assert (np.abs(share).max(axis=(0, 1)) > 0.97).all()
    assert np.abs(share.mean(axis=(0, 1))).max() < 0.2
    assert np.allclose(share[:, 0].std(axis=0), 1 / np.sqrt(3), atol=0.15)


def test_they_drift_slowly_and_without_jumps():
    after = 10.0  # [s], before the bounds matter much
    change = WALKS[:, int(after / 0.5)] - WALKS[:, 0]
    expected = np.sqrt(after) * np.array((SIZE.position_drift, SIZE.position_drift, SIZE.turn_drift))
    assert (np.abs(change.std(axis=0) / expected - 1.0) < 0.35).all()
    rate = np.abs(np.diff(WALKS, axis=1)) / 0.5
    assert (rate[..., :2] < 0.01).all(), "a drift is no motion [m/s]"


def test_the_error_depends_on_the_time_and_not_on_how_often_it_is_asked_for():
    once = Localisation(stream(101, "localisation")).error(30.3)
    often = Localisation(stream(101, "localisation"))
    for time in (0.0, 12.0, 30.3, 5.0):
        often.error(time)
    np.testing.assert_array_equal(often.error(30.3), once)
    assert (once != Localisation(stream(102, "localisation")).error(30.3)).all()


def test_a_heading_stays_within_one_turn():
    located = Localisation(stream(103, "localisation"))
    for yaw in (-np.pi, np.pi - 1e-6):
        seen = located.measured(np.array((1.0, 2.0, yaw)), 7.0)
        assert -np.pi <= seen[2] < np.pi
        np.testing.assert_allclose(np.exp(1j * seen[2]), np.exp(1j * (yaw + located.error(7.0)[2])))


def test_a_hand_moves_along_the_map_as_the_robot_has_turned_it():
    located = Localisation(stream(104, "localisation"))
    asked = HandTwist(side="left", twist_in_map=np.array((0.1, 0.0, 0.05, 0.0, 0.2, 0.3)))
    done = located.executed(asked, 3.0)
    heading = np.arctan2(done.twist_in_map[1], done.twist_in_map[0])
    assert heading == pytest.approx(-located.error(3.0)[2])
    np.testing.assert_array_equal(done.twist_in_map[[2, 5]], (0.05, 0.3))
    np.testing.assert_allclose(located.told(done, 3.0).twist_in_map, asked.twist_in_map, atol=1e-12)

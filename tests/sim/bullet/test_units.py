"""A world in a small unit of time holds the same physics."""

import pytest
from caretree.sim.bullet.units import TimeUnit

MILLISECONDS = TimeUnit(1000.0)


def test_times_rates_and_forces_scale_by_their_dimension():
    assert MILLISECONDS.time(2.0) == pytest.approx(2000.0)  # 2 s
    assert MILLISECONDS.rate(3.0) == pytest.approx(0.003)  # 3 m/s
    assert MILLISECONDS.force(5.0) == pytest.approx(5e-6)  # 5 N: kg m / ms^2


def test_a_free_fall_goes_as_far():
    seconds, gravity = 0.7, 9.81
    time = MILLISECONDS.time(seconds)
    assert MILLISECONDS.force(gravity) * time**2 / 2 == pytest.approx(gravity * seconds**2 / 2)  # [m]


def test_a_second_is_a_second():
    assert TimeUnit(1.0).is_second
    assert not MILLISECONDS.is_second
    assert TimeUnit(1.0).residual == pytest.approx(1e6 * MILLISECONDS.residual)  # compares squared velocities

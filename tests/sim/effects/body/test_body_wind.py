"""Drag in air that rises or sinks."""

import numpy as np
import pytest
from caretree.sim.effects.body.body_wind import BodyWind

FALLING = np.array((0.0, 0.0, -4.0))  # [m/s]


VALUES = {"coefficient": 0.1, "speed": 2.0}  # [1/m], [m/s] upwards


def test_a_body_at_rest_is_blown_along():
    assert BodyWind().specific_force(np.zeros(3), VALUES, 9.81) == pytest.approx([0.0, 0.0, 0.4])  # [m/s^2]


def test_counts_the_velocity_relative_to_the_air():
    assert BodyWind().specific_force(FALLING, VALUES, 9.81) == pytest.approx([0.0, 0.0, 3.6])  # 6 m/s against the air


def test_leaves_the_velocity_it_was_given_alone():
    velocity = FALLING.copy()
    BodyWind().specific_force(velocity, VALUES, 9.81)
    assert velocity == pytest.approx(FALLING)

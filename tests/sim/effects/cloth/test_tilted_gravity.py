"""A scene whose frame is not level."""

import numpy as np
import pytest
from caretree.sim.effects.cloth.cloth_effect import ClothSettings
from caretree.sim.effects.cloth.tilted_gravity import TiltedGravity

LEVEL = ClothSettings(friction=0.4, gravity=(0.0, 0.0, -9.81))


def test_gravity_leans_by_the_angle_and_keeps_its_size():
    tilted = TiltedGravity().settings(LEVEL, {"towards_x": 0.1, "towards_y": 0.0})
    assert tilted.gravity == pytest.approx((9.81 * np.sin(0.1), 0.0, -9.81 * np.cos(0.1)))  # [m/s^2]
    assert tilted.friction == 0.4


def test_a_level_scene_is_left_as_it_is():
    assert TiltedGravity().settings(LEVEL, {"towards_x": 0.0, "towards_y": 0.0}).gravity == pytest.approx(LEVEL.gravity)

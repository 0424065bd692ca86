"""How a height is recorded."""

import numpy as np
import pytest
from caretree.sim.effects.body.height_reading import HeightDelay, HeightGain, HeightOffset


def test_a_wrong_scale_and_a_wrong_zero():
    assert HeightGain().read(10.0, {"fraction": 0.02}) == pytest.approx(10.2)  # [m]
    assert HeightOffset().read(10.0, {"value": -0.3}) == pytest.approx(9.7)  # [m]


def test_a_late_clock_changes_no_height():
    assert HeightDelay().read(10.0, {"time": 0.1}) == 10.0


@pytest.mark.parametrize("effect", [HeightGain(), HeightOffset(), HeightDelay()], ids=lambda effect: effect.name)
def test_the_body_falls_as_it_would_without(effect):
    values = {effect.parameters[0].name: 0.1}
    assert not effect.specific_force(np.array((0.0, 0.0, -5.0)), values, 9.81).any()

"""Lift by the displaced air."""

import numpy as np
import pytest
from caretree.sim.effects.body.buoyancy import Buoyancy
from caretree.sim.effects.effect import EffectError

FALLING = np.array((0.0, 0.0, -4.0))  # [m/s]


@pytest.mark.parametrize("velocity", [FALLING, np.zeros(3)])
def test_takes_off_a_share_of_the_weight_whatever_the_speed(velocity):
    assert Buoyancy().specific_force(velocity, {"fraction": 0.2}, 10.0) == pytest.approx([0.0, 0.0, 2.0])  # [m/s^2]


def test_a_balloon_is_not_a_falling_body():
    with pytest.raises(EffectError, match=r"fraction = 1\.2"):
        Buoyancy().check({"fraction": 1.2})

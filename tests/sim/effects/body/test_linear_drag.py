"""Air drag in proportion to speed."""

import numpy as np
import pytest
from caretree.sim.effects.body.linear_drag import LinearDrag

FALLING = np.array((0.0, 0.0, -4.0))  # [m/s]


def test_is_against_the_velocity_and_in_proportion():
    force = LinearDrag().specific_force(np.array((1.0, 0.0, -4.0)), {"rate": 0.5}, 9.81)
    assert force == pytest.approx([-0.5, 0.0, 2.0])  # [m/s^2]


def test_many_velocities_at_once():
    force = LinearDrag().specific_force(np.array((FALLING, 2 * FALLING)), {"rate": 0.5}, 9.81)
    assert force[:, 2] == pytest.approx([2.0, 4.0])

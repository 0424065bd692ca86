"""Air drag in proportion to speed squared."""

import numpy as np
import pytest
from caretree.sim.effects.body.quadratic_drag import QuadraticDrag

FALLING = np.array((0.0, 0.0, -4.0))  # [m/s]


def test_grows_with_the_square_of_the_speed():
    once, twice = (QuadraticDrag().specific_force(n * FALLING, {"coefficient": 0.1}, 9.81)[2] for n in (1, 2))
    assert (once, twice) == pytest.approx((1.6, 6.4))  # [m/s^2]


def test_is_along_the_whole_velocity_not_each_axis():
    force = QuadraticDrag().specific_force(np.array((3.0, 0.0, -4.0)), {"coefficient": 0.1}, 9.81)
    assert force == pytest.approx([-1.5, 0.0, 2.0])  # 0.1 /m times 5 m/s times the velocity

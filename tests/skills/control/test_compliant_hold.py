import numpy as np
import pytest
from caretree.skills.control.compliant_hold import compliant_velocity

from ..moving import idle, robot


def test_an_arm_s_weight_and_small_pulls_are_borne():
    for load in ((0.0, 0.0, -18.0), (4.0, -3.0, 0.0), (0.0, 0.0, 5.0)):
        np.testing.assert_allclose(compliant_velocity(idle(robot()[1]), "left", np.array(load)), 0.0)


@pytest.mark.parametrize("load", [(12.0, 0.0, 0.0), (-8.0, 8.0, -10.0), (0.0, 0.0, 15.0), (0.0, 0.0, -40.0)])
def test_a_harder_pull_is_followed_slowly(load):
    velocity = compliant_velocity(idle(robot()[1]), "left", np.array(load))
    assert velocity @ np.array(load) > 0
    assert 0 < np.linalg.norm(velocity) <= 0.03 + 1e-9

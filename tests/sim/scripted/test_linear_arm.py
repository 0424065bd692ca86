"""The made-up arm is one arm: its positions, its Jacobian and its inverse agree."""

import numpy as np
import pytest
from caretree.sim.scripted.linear_arm import LinearArms
from caretree.sim.world import SIDES

ARMS = LinearArms()
BASE = np.array((1.0, -2.0, 0.7))  # [m, m, rad]


@pytest.mark.parametrize("side", SIDES)
def test_the_jacobian_is_the_derivative_of_the_pose(side):
    q = np.random.default_rng(0).uniform(-0.5, 0.5, 7)
    step, pose = 1e-6, ARMS.pose_hand_in_map(side, q, BASE)
    for joint, column in enumerate(ARMS.jacobian_hand_in_map(side, q, BASE).T):
        moved = ARMS.pose_hand_in_map(side, q + step * np.eye(7)[joint], BASE)
        turn = (moved[:3, :3] - pose[:3, :3]) @ pose[:3, :3].T / step  # skew of the angular velocity
        assert column[:3] == pytest.approx((moved[:3, 3] - pose[:3, 3]) / step, abs=1e-5)
        assert column[3:] == pytest.approx((turn[2, 1], turn[0, 2], turn[1, 0]), abs=1e-5)


@pytest.mark.parametrize("side", SIDES)
def test_the_inverse_brings_the_hand_there_without_turning_it(side):
    q = np.array((0.1, 0.2, -0.3, 0.4, 0.5, 0.6, 0.7))
    goal = np.array((1.8, -1.4, 1.1))  # [m]
    solved = ARMS.joints_for(side, goal, q, BASE)
    pose = ARMS.pose_hand_in_map(side, solved, BASE)
    assert pose[:3, 3] == pytest.approx(goal)
    assert pose[:3, :3] == pytest.approx(ARMS.pose_hand_in_map(side, q, BASE)[:3, :3])


def test_the_left_hand_is_on_the_left():
    left, right = (ARMS.pose_hand_in_map(side, np.zeros(7), np.zeros(3))[1, 3] for side in SIDES)
    assert left == -right > 0.0

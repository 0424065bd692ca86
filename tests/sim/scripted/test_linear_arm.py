"""The made-up arm is one arm: its positions and its Jacobian agree."""

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
def test_the_first_three_joints_carry_the_hand_without_turning_it(side):
    before, after = (ARMS.pose_hand_in_map(side, np.array((x, 0, 0, 0.4, 0.5, 0.6, 0.7)), BASE) for x in (0.0, 0.8))
    assert after[:3, :3] == pytest.approx(before[:3, :3])
    ahead = np.array((np.cos(0.7), np.sin(0.7), 0.0))
    assert after[:3, 3] - before[:3, 3] == pytest.approx(0.4 * ahead)  # [m]: half a metre for each radian


def test_the_left_hand_is_on_the_left():
    left, right = (ARMS.pose_hand_in_map(side, np.zeros(7), np.zeros(3))[1, 3] for side in SIDES)
    assert left == -right > 0.0

"""Limits of joints, told alike to the servo, the scripted world and a robot behind a master."""

import numpy as np
import pytest
from caretree.sim.mechanics.joint_limits import JointLimits, fastest_rates, smooth_slopes
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.world import SIDES, JointTrajectory
from scipy.interpolate import CubicHermiteSpline


def test_they_are_those_of_the_arms_and_the_head():
    kinematics = kinematics_of(BAXTER)
    limits = JointLimits.of(kinematics)
    assert limits.joints == BAXTER.commanded_joints
    for found, name in zip(limits.of_arms(), ("lower", "upper", "velocity"), strict=True):
        np.testing.assert_array_equal(found, [getattr(kinematics.limits[side], name) for side in SIDES])
    assert (limits.lower[-1], limits.upper[-1]) == kinematics.head_range
    assert limits.velocity[-1] == BAXTER.limits.head_velocity
    assert JointLimits.of(kinematics, head_velocity=0.1).velocity[-1] == 0.1
    assert not limits.unlimited


def test_a_made_up_arm_has_none():
    limits = JointLimits.none(BAXTER)
    assert limits.unlimited
    lower, upper, _ = limits.of_arms()
    assert np.clip(np.full((2, 7), 1e6), lower, upper).min() == 1e6


def test_the_order_of_a_trajectory_s_joints_is_its_own():
    limits = JointLimits.of(kinematics_of(BAXTER))
    joints = ("head_pan", "right_e1", "left_e1")
    far = JointTrajectory(
        joints=joints, times=np.array((0.0, 30.0)), positions=np.array(((0.0,) * 3, (9.0, 9.0, -9.0)))
    )
    sent, slopes = limits.trajectory(far)
    index = [limits.joints.index(name) for name in joints]
    np.testing.assert_array_equal(sent.positions[-1], (*limits.upper[index[:2]], limits.lower[index[2]]))
    assert slopes.shape == (2, 3)
    assert sent.times[-1] == 30.0


def test_slopes_never_overshoot():
    times, positions = np.arange(4.0), np.array(((0.0,), (1.0,), (1.0,), (2.0,)))
    assert np.array_equal(smooth_slopes(times, positions)[:, 0], np.zeros(4))


@pytest.mark.parametrize("points", [2, 3, 30])
def test_the_fastest_rates_are_those_of_the_cubics(points):
    rng = np.random.default_rng(points)
    times = np.cumsum(rng.uniform(0.05, 1.0, points))
    positions = rng.normal(size=(points, 4))
    positions[:, 0] = 1.0  # a joint that rests
    for slopes in (smooth_slopes(times, positions), rng.normal(size=(points, 4))):
        rates = CubicHermiteSpline(times, positions, slopes).derivative()(np.linspace(times[0], times[-1], 20_000))
        assert fastest_rates(times, positions, slopes) == pytest.approx(np.abs(rates).max(axis=0), rel=1e-3)

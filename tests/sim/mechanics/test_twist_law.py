"""What a hand does for its twist is, compiled, what the same written with numpy and pinocchio is, to rounding."""

import numpy as np
import pinocchio as pin
import pytest
from caretree.sim.mechanics.kinematics import Kinematics
from caretree.sim.mechanics.planar import planar_pose
from caretree.sim.mechanics.twist_law import lead, ramp, swing
from caretree.sim.robot.baxter import BAXTER


def ramped(twist, wanted, limits):
    twist = twist.copy()
    for part, limit in zip((slice(0, 3), slice(3, 6)), limits, strict=True):
        change = wanted[part] - twist[part]
        twist[part] += change * min(1.0, limit / max(float(np.linalg.norm(change)), 1e-12))
    return twist


def led(goal, twist, dt, base, twist_base, pose):
    """New goal, and the velocity along the hand's axes."""
    target = goal.copy()
    target[:3, 3] += twist[:3] * dt
    target[:3, :3] = pin.exp3(twist[3:] * dt) @ goal[:3, :3]
    offset = target[:3, 3] - pose[:3, 3]
    turn = pin.log3(np.ascontiguousarray(target[:3, :3] @ pose[:3, :3].T))
    far, angle = float(np.linalg.norm(offset)), float(np.linalg.norm(turn))
    if far > 0.01:
        target[:3, 3] = pose[:3, 3] + offset * (0.01 / far)
    if angle > 0.06:
        target[:3, :3] = pin.exp3(turn * (0.06 / angle)) @ pose[:3, :3]
    R = pose[:3, :3]
    error = np.concatenate((target[:3, 3] - pose[:3, 3], pin.log3(np.ascontiguousarray(target[:3, :3] @ R.T))))
    carried = np.zeros(6)
    x, y = pose[:2, 3] - base[:2, 3]
    carried[:2] = base[:2, :2] @ twist_base[:2] + twist_base[2] * np.array((-y, x))
    carried[5] = twist_base[2]
    velocity = twist + 8.0 * error - carried
    return target, np.concatenate((R.T @ velocity[:3], R.T @ velocity[3:]))


def pose_near(pose, rng, far, angle):
    near = pose.copy()
    near[:3, 3] += rng.normal(size=3) * far
    near[:3, :3] = pin.exp3(rng.normal(size=3) * angle) @ pose[:3, :3]
    return near


@pytest.mark.parametrize("far", [0.0, 0.001, 0.005, 0.1])
@pytest.mark.parametrize("angle", [0.0, 0.01, 0.03, 0.8])
def test_hands_lead_alike(far, angle):
    rng = np.random.default_rng(7)
    for _ in range(50):
        hand = np.eye(4)
        hand[:3, :3], hand[:3, 3] = pin.exp3(rng.normal(size=3)), rng.normal(size=3)
        goal, base = pose_near(hand, rng, far, angle), planar_pose(rng.normal(size=3))
        twist, twist_base = rng.normal(size=6) * 0.2, rng.normal(size=3) * rng.choice((0.0, 0.3))
        expected, velocity = led(goal, twist, 0.01, base, twist_base, hand)
        np.testing.assert_allclose(lead(goal, twist, 0.01, base, twist_base, hand), velocity, rtol=0, atol=1e-13)
        np.testing.assert_allclose(goal, expected, rtol=0, atol=1e-14)


def test_twists_are_ramped_alike():
    rng = np.random.default_rng(8)
    for size in (0.0, 1e-14, 1e-3, 0.1):
        for _ in range(50):
            twist = rng.normal(size=6) * 0.2
            wanted = twist + rng.normal(size=6) * size
            expected = ramped(twist, wanted, (0.005, 0.02))
            assert ramp(twist, wanted, 0.005, 0.02) == pytest.approx(np.abs(expected).max(), abs=1e-16)
            np.testing.assert_allclose(twist, expected, rtol=0, atol=1e-16)


def test_the_fastest_joint_is_what_moving_the_joints_shows():
    kinematics, rng, step = Kinematics(BAXTER), np.random.default_rng(4), 1e-6
    for _ in range(20):
        q, rates = rng.uniform(-1.0, 1.0, (2, 7))
        hand, jacobian, places = kinematics.hand_and_joints("right", q)
        later = kinematics.hand_and_joints("right", q + step * rates)[2]
        fastest = np.linalg.norm((later - places) / step, axis=1).max()
        seen_from_hand = (places - hand[:3, 3]) @ hand[:3, :3]
        assert swing(jacobian, seen_from_hand, rates) == pytest.approx(fastest, abs=1e-4)

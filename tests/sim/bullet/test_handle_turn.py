"""Targets of a handle's motors, compiled, are those of plain Python to the last bit."""

import math

import numpy as np
import pytest
from caretree.sim.bullet.handle_turn import motor_targets
from scipy.spatial.transform import Rotation


def plainly(pose, turn_at_reset, last):
    (a, _, _), (b, _, _), (c, d, e) = (pose[:3, :3] @ turn_at_reset.T).tolist()
    z, y, x = math.atan2(b, a), math.asin(min(1.0, max(-1.0, -c))), math.atan2(d, e)
    ways, found = ((z, y, x), (z + math.pi, math.pi - y, x + math.pi)), (math.inf, (z, y, x))
    if max(abs(angle - before) for angle, before in zip((z, y, x), last[3:].tolist(), strict=True)) < math.pi / 2:
        return np.array((*pose[:3, 3], z, y, x))
    for way in ways:
        whole = tuple(
            angle + 2 * math.pi * round((before - angle) / (2 * math.pi))
            for angle, before in zip(way, last[3:].tolist(), strict=True)
        )
        apart = max(abs(angle - before) for angle, before in zip(whole, last[3:].tolist(), strict=True))
        found = min(found, (apart, whole), key=lambda each: each[0])
    return np.array((*pose[:3, 3], *found[1]))


@pytest.mark.parametrize("turn", [0.0, 0.1, 1.0, 3.0])
@pytest.mark.parametrize("wound", [0.1, 4.0, 20.0])
def test_targets(turn, wound):
    rng = np.random.default_rng(3)
    for _ in range(200):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = Rotation.from_rotvec(turn * rng.normal(size=3)).as_matrix(), rng.normal(size=3)
        reset = Rotation.random(random_state=rng).as_matrix()
        last = rng.normal(size=6) * np.repeat((1.0, wound), 3)
        assert motor_targets(pose, reset, last).tobytes() == plainly(pose, reset, last).tobytes()


def test_looking_straight_down():
    down = np.eye(4)
    down[:3, :3] = ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))  # a turn by a quarter about y
    np.testing.assert_allclose(motor_targets(down, np.eye(3), np.zeros(6))[4], -np.pi / 2)


def test_angles_are_those_of_the_rotation_and_never_jump():
    rng = np.random.default_rng(5)
    last, pose = np.zeros(6), np.eye(4)
    turn = Rotation.identity()
    for _ in range(400):
        turn = Rotation.from_rotvec(rng.normal(0.0, 0.08, 3)) * turn
        pose[:3, :3] = turn.as_matrix()
        targets = motor_targets(pose, np.eye(3), last)
        angles = targets[3:]
        assert Rotation.from_euler("ZYX", angles).as_matrix() == pytest.approx(turn.as_matrix(), abs=1e-9)
        if abs(np.cos(angles[1])) > 0.5:  # near the pole they turn fast
            assert np.abs(targets - last).max() < 1.0
        last = targets

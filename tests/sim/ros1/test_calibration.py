"""What a sensor's zero, place and burden add is taken away again."""

import numpy as np
from caretree.sim.ros1.calibration import carried_on, felt_by_sensor, load_at_hand, way_between
from caretree.sim.ros1.site import Wrist, transform

WRIST = Wrist(
    topic="/wrist",
    frame="wrist",
    xyz=(0.01, -0.02, -0.16),
    rpy=(0.2, -0.1, 1.5),
    mass=0.9,
    centre=(0.0, 0.01, -0.1),
    zero=(1.0, -2.0, 3.0, 0.1, -0.2, 0.3),
    rate=100.0,
)
TURN = transform((0.0, 0.0, 0.0), (2.8, 0.3, -0.7))[:3, :3]


def test_a_load_is_found_again():
    load = np.array((4.0, -5.0, 6.0, 0.3, 0.2, -0.1))
    felt = felt_by_sensor(load, WRIST, TURN)
    assert np.abs(felt[:3] - load[:3]).max() > 1.0
    assert np.allclose(load_at_hand(felt, WRIST, TURN), load)


def test_an_empty_hand_feels_its_own_weight_and_tells_none():
    felt = felt_by_sensor(np.zeros(6), WRIST, TURN) - WRIST.zero
    assert np.isclose(np.linalg.norm(felt[:3]), 0.9 * 9.81)
    assert np.allclose(load_at_hand(felt + WRIST.zero, WRIST, TURN), 0.0)


def test_odometry_carries_a_pose_on():
    poses = np.array(((1.0, 2.0, 3.0), (-1.0, 0.5, -2.9), (0.0, 0.0, 0.2)))
    for first in poses:
        for second in poses:
            assert np.allclose(carried_on(first, way_between(first, second)), second)

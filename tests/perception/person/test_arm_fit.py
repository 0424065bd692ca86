"""Geometry of an arm as a chain of joints."""

import numpy as np
from caretree.perception.person.arm_fit import point_along, turned, turned_about_shoulder

ARM = np.array(((0.2, -0.5, 0.7), (0.35, -0.27, 0.68), (0.42, -0.03, 0.66), (0.46, 0.13, 0.65)))


def test_a_held_arm_is_turned_as_one_piece_to_where_the_hand_holds_it():
    raised = ARM[0] + np.linalg.norm(ARM[1] - ARM[0]) * np.array((0.6, 0.0, 0.8))
    turned = turned_about_shoulder(ARM, 1.0, raised)
    np.testing.assert_allclose(turned[0], ARM[0])
    np.testing.assert_allclose(turned[1], raised, atol=1e-9)
    for a in range(4):
        for b in range(a):
            assert np.isclose(np.linalg.norm(turned[a] - turned[b]), np.linalg.norm(ARM[a] - ARM[b]))
    np.testing.assert_allclose(turned_about_shoulder(ARM, 1.0, ARM[1]), ARM, atol=1e-9)


def test_a_place_along_the_arm():
    np.testing.assert_allclose(point_along(ARM, 0.0), ARM[0])
    np.testing.assert_allclose(point_along(ARM, 1.5), (ARM[1] + ARM[2]) / 2)
    np.testing.assert_allclose(point_along(ARM, 3.0), ARM[3])


def test_points_turn_about_another_the_shortest_way():
    about = np.array((1.0, 0.0, 0.0))
    points = about + np.eye(3)
    quarter = turned(points, about, about + (2.0, 0.0, 0.0), about + (0.0, 3.0, 0.0))
    np.testing.assert_allclose(quarter - about, ((0, 1, 0), (-1, 0, 0), (0, 0, 1)), atol=1e-12)
    np.testing.assert_allclose(turned(points, about, points[0], points[0]), points)

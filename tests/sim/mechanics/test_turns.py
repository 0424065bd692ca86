"""Turns are scipy's, to the last bit."""

import numpy as np
import pytest
from caretree.sim.mechanics.turns import turn_matrix, turn_vector
from scipy.spatial.transform import Rotation


def vectors(angle):
    axes = np.concatenate((np.random.default_rng(1).normal(size=(200, 3)), np.eye(3), -np.eye(3), ((1.0, 1.0, 0.0),)))
    return angle * axes / np.linalg.norm(axes, axis=1)[:, None]


@pytest.mark.parametrize("angle", [0.0, 1e-300, 1e-9, 4e-4, 9.99e-4, 1e-3, 1.1e-3, 0.02, 0.5, 1.5, 3.0, np.pi, 4.0])
def test_turns_are_those_of_scipy(angle):
    for vector in vectors(angle):
        matrix = turn_matrix(vector)
        np.testing.assert_array_equal(matrix, Rotation.from_rotvec(vector).as_matrix())
        np.testing.assert_array_equal(turn_vector(matrix), Rotation.from_matrix(matrix).as_rotvec())
        turned = matrix @ turn_matrix(vectors(1.0)[0])
        np.testing.assert_array_equal(turn_vector(turned), Rotation.from_matrix(turned).as_rotvec())


def test_points_turned_by_the_matrix_are_those_of_scipy():
    points = np.random.default_rng(2).normal(size=(4, 3))
    for vector in vectors(0.7):
        np.testing.assert_array_equal(points @ turn_matrix(vector).T, Rotation.from_rotvec(vector).apply(points))

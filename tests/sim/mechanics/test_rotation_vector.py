"""Rotations and their vectors are pinocchio's, to rounding, at any angle."""

import numpy as np
import pinocchio as pin
import pytest
from caretree.sim.compiled import njit
from caretree.sim.mechanics.rotation_vector import rotation, rotation_vector

ANGLES = (0.0, 1e-300, 1e-15, 1e-9, 1e-7, 1e-4, 0.02, 0.5, 1.5, 2.2, 3.0, 3.14159, np.pi - 1e-9)

turn = njit()(lambda vector: rotation(vector))
measure = njit()(lambda matrix: rotation_vector(matrix))


def vectors(angle):
    axes = np.concatenate((np.random.default_rng(1).normal(size=(40, 3)), np.eye(3), -np.eye(3), ((1.0, 1.0, 0.0),)))
    return angle * axes / np.linalg.norm(axes, axis=1)[:, None]


@pytest.mark.parametrize("angle", ANGLES)
def test_rotations(angle):
    for vector in vectors(angle):
        np.testing.assert_allclose(turn(vector), pin.exp3(vector), rtol=0, atol=1e-15)


@pytest.mark.parametrize("angle", ANGLES)
def test_vectors(angle):
    for vector in vectors(angle):
        np.testing.assert_allclose(measure(pin.exp3(vector)), vector, rtol=0, atol=2e-15 if angle < 3.0 else 1e-14)


def test_half_a_turn():
    for vector in vectors(np.pi):
        got = measure(pin.exp3(vector))
        np.testing.assert_allclose(np.outer(got, got), np.outer(vector, vector), atol=1e-7)

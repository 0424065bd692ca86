"""Lengths and products of vectors are numpy's."""

import numpy as np
import pytest
from caretree.sim.vector import cross, length


@pytest.mark.parametrize("size", [2, 3, 6, 7, 14])
def test_the_length_is_that_of_numpy_to_the_last_bit(size):
    vectors = np.random.default_rng(size).normal(size=(200, size))
    assert [length(vector) for vector in vectors] == [float(np.linalg.norm(vector)) for vector in vectors]
    assert length(np.zeros(size)) == 0.0


def test_a_part_of_an_array_has_a_length_too():
    poses = np.random.default_rng(1).normal(size=(2, 4, 4))
    assert length(poses[1, :3, 3]) == float(np.linalg.norm(poses[1, :3, 3]))


def test_the_product_is_that_of_numpy_to_the_last_bit():
    pairs = np.random.default_rng(2).normal(size=(200, 2, 3))
    assert all((cross(a, b) == np.cross(a, b)).all() for a, b in pairs)

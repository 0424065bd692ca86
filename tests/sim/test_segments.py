"""Distances between segments, against a search over both of them."""

import numpy as np
import pytest
from caretree.sim.segments import segment_distances


def searched(one, other):
    """Least distance by trying 400 x 400 points."""
    shares = np.linspace(0.0, 1.0, 400)[:, None]
    a, b = one[0] + shares * (one[1] - one[0]), other[0] + shares * (other[1] - other[0])
    return np.linalg.norm(a[:, None] - b[None], axis=2).min()


def test_distances_are_the_least_ones():
    rng = np.random.default_rng(3)
    one, other = rng.normal(size=(6, 2, 3)), rng.normal(size=(5, 2, 3))
    got, offsets = segment_distances(one, other)
    for i in range(6):
        for j in range(5):
            assert got[i, j] == pytest.approx(searched(one[i], other[j]), abs=2e-2)
            assert got[i, j] <= searched(one[i], other[j]) + 1e-12
    assert np.linalg.norm(offsets, axis=2) == pytest.approx(got)


@pytest.mark.parametrize(
    ("one", "other", "distance"),
    [
        (((0, 0, 0), (0, 0, 0)), ((3, 4, 0), (3, 4, 0)), 5.0),
        (((0, 0, 0), (0, 0, 0)), ((-1, 2, 0), (1, 2, 0)), 2.0),
        (((-1, 2, 0), (1, 2, 0)), ((0, 0, 0), (0, 0, 0)), 2.0),
        (((0, 0, 0), (1, 0, 0)), ((0, 1, 0), (1, 1, 0)), 1.0),
        (((0, 0, 0), (1, 0, 0)), ((2, 0, 0), (3, 0, 0)), 1.0),
        (((0, 0, 0), (2, 0, 0)), ((1, -1, 0), (1, 1, 0)), 0.0),
    ],
)
def test_points_parallels_and_crossings(one, other, distance):
    got, offsets = segment_distances(np.array([one], float), np.array([other], float))
    assert got[0, 0] == pytest.approx(distance)
    assert np.linalg.norm(offsets[0, 0]) == pytest.approx(distance)

"""Distances between segments, against a search over both of them."""

import numpy as np
import pytest
from caretree.sim.segments import (
    any_nearer,
    box_distances,
    capsule_gaps,
    furthest_moved,
    nearest_gaps,
    segment_distances,
)


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


def test_gaps_are_what_is_left_between_surfaces_and_directions_have_length_one():
    rng = np.random.default_rng(4)
    one, other, thick, thin = rng.normal(size=(6, 2, 3)), rng.normal(size=(5, 2, 3)), np.full(6, 0.1), np.full(5, 0.02)
    apart, offsets = segment_distances(one, other)
    gaps, away = capsule_gaps(one, thick, other, thin)
    assert gaps == pytest.approx(apart - 0.12)
    assert away == pytest.approx(offsets / apart[..., None])
    assert nearest_gaps(one, thick, other, thin) == pytest.approx(gaps.min(axis=1))
    assert not any_nearer(one, thick, other, thin, gaps)
    least = gaps.copy()
    least[5, 4] += 1e-9
    assert any_nearer(one, thick, other, thin, least)
    assert nearest_gaps(one, thick, other[:0], thin[:0]).tolist() == [np.inf] * 6


def test_axes_that_meet_have_no_direction_between_them():
    cross = np.array([((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))])
    gaps, away = capsule_gaps(cross, np.array([0.1]), cross[..., [1, 0, 2]], np.array([0.2]))
    assert gaps[0, 0] == pytest.approx(-0.3)
    assert not away.any()


def test_the_end_that_goes_further_counts():
    before = np.zeros((2, 2, 3))
    after = np.array([((3.0, 4.0, 0.0), (1.0, 0.0, 0.0)), ((0.0, 0.0, 0.0), (0.0, 0.0, -2.0))])
    assert furthest_moved(before, after).tolist() == [5.0, 2.0]


def test_distance_to_a_box_is_zero_inside_and_counts_from_its_nearest_face():
    box = np.array(((-1.0, -1.0, 0.0), (1.0, 1.0, 1.0)))
    beside = ((2.0, 0.0, 0.5), (3.0, 0.0, 0.5))
    through = ((-3.0, 0.0, 0.5), (3.0, 0.0, 0.5))
    above_a_corner = ((4.0, 5.0, 1.0), (4.0, 5.0, 9.0))
    assert box_distances(np.array((beside, through, above_a_corner)), box).tolist() == [1.0, 0.0, 5.0]


def test_short_capsules_are_told_near_as_their_gaps_say():
    generator = np.random.default_rng(0)
    found = []
    for _ in range(200):
        start = generator.normal(size=(5, 2, 1, 3))
        ends = np.concatenate((start, start + 0.2 * generator.normal(size=start.shape)), axis=2)
        one, other = np.ascontiguousarray(ends[:, 0]), np.ascontiguousarray(ends[:, 1])
        radii, least = generator.uniform(0.0, 0.1, 5), generator.normal(-0.1, 0.1, (5, 5))
        near = bool((capsule_gaps(one, radii, other, radii)[0] < least).any())
        assert any_nearer(one, radii, other, radii, least) == near
        found.append(near)
    assert any(found)
    assert not all(found)

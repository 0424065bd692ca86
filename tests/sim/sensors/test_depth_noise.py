"""What a consumer depth camera makes of a picture."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.scene.difficulties import SIZES, stream
from caretree.sim.sensors.depth_noise import disturbed_depth

SIZE = SIZES.depth_noise
STEPS_ONLY = replace(SIZE, flying=0.0, edge_dropout=0.0, dropout=0.0)


def rng():
    return stream(100, "depth_noise")


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0])
def test_depth_comes_in_steps_that_grow_with_the_square_of_the_distance(distance):
    ramp = np.linspace(0.9 * distance, 1.1 * distance, 40000, dtype=np.float32).reshape(100, 400)
    seen = disturbed_depth(ramp, rng(), STEPS_ONLY)
    levels = np.unique(seen)
    at = np.argmin(np.abs(levels - distance))
    assert levels[at + 1] - levels[at] == pytest.approx(0.00285 * distance**2, rel=0.05)
    assert np.abs(seen - ramp).max() < 0.55 * 0.00285 * (1.1 * distance) ** 2
    assert seen.dtype == np.float32


def two_surfaces():
    depth = np.full((200, 300), 1.5, dtype=np.float32)
    depth[:, :150] = 1.0
    return depth


def test_pixels_fly_between_the_two_sides_of_an_edge_and_nowhere_else():
    seen = disturbed_depth(two_surfaces(), rng(), replace(SIZE, edge_dropout=0.0, dropout=0.0))
    flies = (seen > 1.01) & (seen < 1.49)
    assert flies[:, 149:151].mean() == pytest.approx(SIZE.flying, abs=0.07)
    assert not flies[:, :149].any()
    assert not flies[:, 151:].any()
    assert seen[flies].std() > 0.1, "anywhere between them"
    assert seen[flies & (np.arange(300) == 149)].mean() == pytest.approx(1.25, abs=0.05)


def test_a_slope_is_no_edge():
    slope = np.tile(np.linspace(1.0, 1.0 + 0.03 * 299, 300, dtype=np.float32), (50, 1))
    seen = disturbed_depth(slope, rng(), replace(SIZE, edge_dropout=1.0, dropout=0.0))
    assert (seen > 0).all()


def test_some_pixels_have_no_depth_and_more_of_them_at_edges():
    seen = disturbed_depth(two_surfaces(), rng())
    assert (seen[:, :149] == 0).mean() == pytest.approx(0.02, abs=0.004)
    assert (seen[:, 149:151] == 0).mean() == pytest.approx(0.2, abs=0.06)


def test_what_had_no_depth_has_none_and_makes_no_edge():
    depth = two_surfaces()
    depth[:, 140:160] = 0.0
    seen = disturbed_depth(depth, rng(), replace(SIZE, edge_dropout=1.0, dropout=0.0))
    np.testing.assert_array_equal(seen == 0, depth == 0)
    assert np.isfinite(seen).all()


def test_the_same_stream_is_the_same_picture_and_the_next_one_differs():
    one, other = rng(), rng()
    first = disturbed_depth(two_surfaces(), one)
    np.testing.assert_array_equal(first, disturbed_depth(two_surfaces(), other))
    assert (first != disturbed_depth(two_surfaces(), one)).any()

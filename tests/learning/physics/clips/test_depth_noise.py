import numpy as np
from caretree.learning.physics.clips.depth_noise import disturb


def square():
    depth = np.full((200, 64, 64), np.nan, np.float32)
    depth[:, 20:44, 20:44] = 2.0
    return depth


def test_noise_grows_with_the_square_of_the_distance():
    noisy = disturb(square(), np.random.default_rng(0), sigma=0.002, edge_loss=0.0, holes=0.0)
    np.testing.assert_array_equal(np.isnan(noisy), np.isnan(square()))
    assert abs(np.nanstd(noisy) - 0.008) < 1e-4
    assert abs(np.nanmean(noisy) - 2.0) < 1e-4


def test_only_the_outline_is_lost_at_edges():
    lost = np.isnan(disturb(square(), np.random.default_rng(0), edge_loss=0.5, holes=0.0)) & np.isfinite(square())
    assert not lost[:, 21:43, 21:43].any()
    assert abs(lost.sum() / (200 * (24 * 4 - 4)) - 0.5) < 0.02


def test_holes_lie_on_the_gown_and_never_take_all_of_it():
    depth = np.full((50, 64, 64), np.nan, np.float32)
    depth[:, 30:32, 30:32] = 2.0
    spoilt = disturb(depth, np.random.default_rng(0), holes=30.0, edge_loss=1.0)
    assert np.isfinite(spoilt).any(axis=(1, 2)).all()
    assert np.isnan(disturb(square(), np.random.default_rng(1), edge_loss=0.0))[:, 22:42, 22:42].any()

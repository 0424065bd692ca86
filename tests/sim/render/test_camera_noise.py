"""The noise of a camera: its spread, its holes, its seed."""

import numpy as np
import pytest
from caretree.sim.render.camera_noise import add_sensor_noise
from caretree.sim.render.raster import Picture


def picture(cosine=1.0, depth=2.0, colour=100, size=(200, 300)):
    """Of a wall that fills it but for its upper half, where there is nothing."""
    seen = np.arange(size[0])[:, None] >= size[0] // 2
    return Picture(
        rgb=np.full((*size, 3), colour, np.uint8),
        depth=np.where(seen, depth, 0.0).repeat(size[1], axis=1).astype(np.float32),
        ids=np.zeros(size, np.int32),
        cosine=np.full(size, cosine, np.float32),
    )


def test_noise_is_normal_and_grows_with_the_square_of_the_distance():
    for depth in (1.0, 2.0):
        rgb, measured = add_sensor_noise(picture(depth=depth), np.random.default_rng(0))
        assert (measured[:100] == 0).all()
        error = (measured[100:] - depth) / (0.002 * depth**2)
        assert error.mean() == pytest.approx(0.0, abs=0.02)
        assert error.std() == pytest.approx(1.0, abs=0.02)
        assert (np.abs(error) < 2.0).mean() == pytest.approx(0.9545, abs=0.004)
        grain = rgb.astype(float) + 0.5 - 100.0  # as it is cut to whole numbers
        assert grain.mean(axis=(0, 1)) == pytest.approx(np.zeros(3), abs=0.05)
        assert grain.std(axis=(0, 1)) == pytest.approx(np.full(3, np.hypot(2.0, np.sqrt(1 / 12))), abs=0.05)
    together = np.corrcoef([*grain[100:].reshape(-1, 3).T, error.ravel()])
    assert np.abs(together - np.eye(4)).max() < 0.03


def test_colours_stay_colours():
    for colour in (0, 255):
        rgb, _ = add_sensor_noise(picture(colour=colour), np.random.default_rng(0))
        assert np.abs(rgb.astype(int) - colour).max() <= 8


@pytest.mark.parametrize(("cosine", "lost"), [(0.04, 1.0), (0.05, 1.0), (0.125, 0.5), (0.17, 0.2), (0.21, 0.0)])
def test_surfaces_that_are_seen_along_give_no_depth(cosine, lost):
    _, depth = add_sensor_noise(picture(cosine=cosine), np.random.default_rng(0))
    assert (depth[100:] == 0).mean() == pytest.approx(lost, abs=0.01)


def test_the_same_seed_gives_the_same_noise():
    first, again, other = (add_sensor_noise(picture(), np.random.default_rng(seed))[0] for seed in (5, 5, 6))
    assert (first == again).all()
    assert (first != other).any()

import numpy as np
import pytest
from caretree.learning.physics.methods.conformal import calibrate


def test_intervals_cover_nine_of_ten_where_errors_depend_on_the_place():
    rng = np.random.default_rng(0)

    def draw(n):
        true = rng.random((n, 2))
        return true, true + rng.normal(size=(n, 2)) * (0.01 + 0.1 * true[:, :1])

    calibration = calibrate(*draw(400), np.ones(400))
    true, estimated = draw(2000)
    lower, upper = calibration.intervals(estimated, np.ones(2000))
    inside = (true >= lower) & (true <= upper)
    assert 0.86 < inside.mean() < 0.94
    for part in (true[:, 0] < 0.3, true[:, 0] > 0.7):  # not too wide here and too narrow there
        assert 0.8 < inside[part].mean() < 0.98


def test_badly_explained_clips_get_wider_intervals():
    rng = np.random.default_rng(0)
    true = rng.uniform(0.4, 0.6, (100, 1))
    calibration = calibrate(true, true + rng.normal(0, 0.01, true.shape), np.ones(100))
    estimated = np.array([[0.5], [0.5]])
    lower, upper = calibration.intervals(estimated, np.array([1.0, 3.0]))
    width = (upper - lower)[:, 0]
    assert width[1] == pytest.approx(3 * width[0])

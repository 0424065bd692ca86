import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.study.metrics import coverage, garment_error, median_interval


def test_error_is_the_papers_mean_relative_error():
    true, estimated = np.array([[2.0, 10.0], [1.0, 1.0]]), np.array([[1.0, 11.0], [1.0, 1.5]])
    np.testing.assert_allclose(garment_error(true, estimated), [0.3, 0.25])
    np.testing.assert_allclose(garment_error(true, estimated, [1]), [0.1, 0.5])


def test_median_has_an_interval_that_narrows_with_clips():
    values = np.random.default_rng(0).exponential(size=2000)
    median, low, high = median_interval(values)
    assert low < np.log(2) < high
    assert low < median < high
    few = median_interval(values[:50])
    assert few[2] - few[1] > 2 * (high - low)


def test_coverage_counts_each_parameter():
    true, lower, upper = np.full((4, 2), 0.5), np.zeros((4, 2)), np.ones((4, 2))
    upper[0, 1] = 0.4
    np.testing.assert_allclose(coverage(true, lower, upper), [1.0, 0.75])

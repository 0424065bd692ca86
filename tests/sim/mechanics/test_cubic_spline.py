"""Splines are scipy's, to the last bit, at, between and beyond their points."""

import numpy as np
import pytest
import scipy.interpolate
from caretree.sim.mechanics.cubic_spline import CubicSpline
from caretree.sim.mechanics.path_timing import toppra


def points(count, width=7, seed=0):
    rng = np.random.default_rng([count, seed])
    return np.cumsum(rng.uniform(0.01, 1.0, count)), rng.normal(size=(count, width))


def compare(ours, scipys, x):
    places = np.concatenate((x, np.linspace(x[0] - 0.1, x[-1] + 0.1, 301)))
    for _ in range(3):
        np.testing.assert_array_equal(ours(places), scipys(places))
        np.testing.assert_array_equal(ours(x[0]), scipys(x[0]))
        ours, scipys = ours.derivative(), scipys.derivative()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("count", [2, 3, 4, 5, 17, 60])
def test_splines_are_those_of_scipy(count, seed):
    x, y = points(count, seed=seed)
    compare(CubicSpline(x, y), scipy.interpolate.CubicSpline(x, y), x)
    ends = ((1, y[0] * 3.0), (1, y[-1] / 3.0))
    compare(CubicSpline(x, y, bc_type=ends), scipy.interpolate.CubicSpline(x, y, bc_type=ends), x)


@pytest.mark.parametrize(("x", "y"), [([0.0], [[1.0]]), ([0.0, 0.0], [[1.0], [2.0]]), ([0.0, 1.0], [[1.0], [np.nan]])])
def test_points_that_no_spline_passes_are_refused(x, y):
    with pytest.raises(ValueError, match="ascending"):
        CubicSpline(np.array(x), np.array(y))


def test_toppra_draws_its_paths_with_these():
    x, y = points(6)
    path = toppra().SplineInterpolator(x, y)
    assert type(path.cspl) is CubicSpline
    np.testing.assert_array_equal(path(x, 1), scipy.interpolate.CubicSpline(x, y).derivative()(x))


def test_what_else_toppra_interpolates_with_is_scipys():
    x, y = points(6, width=1)
    path = toppra().UnivariateSplineInterpolator(x - x[0], y)
    assert np.isfinite(path(x - x[0])).all()
    np.testing.assert_allclose(toppra().SimplePath(x, y)(x), y)

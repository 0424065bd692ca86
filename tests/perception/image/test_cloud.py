"""Planes, lines, patches and distances of made-up clouds."""

import numpy as np
import pytest
from caretree.perception.image.cloud import (
    across,
    clusters,
    geodesic,
    main_direction,
    surface_normal,
    thinned,
    unit,
)


def grid(n, m, step=0.01):
    """A level rectangle of points, n along x and m along y."""
    x, y = np.meshgrid(np.arange(n) * step, np.arange(m) * step)
    return np.column_stack((x.ravel(), y.ravel(), np.zeros(n * m)))


def test_normal_and_direction_of_a_sheet():
    sheet = grid(20, 5)
    np.testing.assert_allclose(surface_normal(sheet, np.array((0.0, 0.0, 2.0))), (0, 0, 1), atol=1e-9)
    np.testing.assert_allclose(surface_normal(sheet, np.array((0.0, 0.0, -2.0))), (0, 0, -1), atol=1e-9)
    np.testing.assert_allclose(np.abs(main_direction(sheet)), (1, 0, 0), atol=1e-9)


def test_two_points_have_the_normal_towards_the_viewer():
    np.testing.assert_allclose(surface_normal(grid(2, 1), np.array((0.005, 3.0, 0.0))), (0, 1, 0), atol=1e-9)


def test_patches_are_numbered_by_size():
    large, small = grid(8, 8), grid(3, 3) + (0.5, 0.0, 0.0)
    labels = clusters(np.vstack((small, large)), 0.012)
    assert (labels[:9] == 1).all()
    assert (labels[9:] == 0).all()
    assert (clusters(np.vstack((small, large)), 0.6) == 0).all()


def test_distances_go_along_the_cloth_and_not_through_the_air():
    angles = np.linspace(0, np.pi, 60)
    bow = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(60)))
    away = geodesic(np.vstack((bow, [(9.0, 0.0, 0.0)])), 0, 0.1)
    assert away[59] == pytest.approx(np.pi, rel=0.01)
    assert np.isinf(away[60])


@pytest.mark.parametrize("edge", [(0.0, 0.0, 1.0), (0.3, -0.5, 0.2), (1.0, 0.0, 0.0)])
def test_fingers_close_across_the_edge(edge):
    approach = np.array((1.0, 0.0, 0.0))  # the last edge lies along it: any direction across it will do
    closing = across(np.array(edge), approach)
    assert np.linalg.norm(closing) == pytest.approx(1.0)
    assert closing @ approach == pytest.approx(0.0, abs=1e-12)
    if edge != (1.0, 0.0, 0.0):
        assert closing @ np.array(edge) == pytest.approx(0.0, abs=1e-12)


def test_unit_vectors():
    np.testing.assert_allclose(unit(np.array((0.0, 3.0, 4.0))), (0, 0.6, 0.8))
    np.testing.assert_allclose(unit(np.zeros(3)), 0.0)


@pytest.mark.parametrize(("count", "left"), [(10, 10), (100, 100), (101, 51), (1000, 100)])
def test_clouds_are_thinned_evenly(count, left):
    kept = thinned(np.arange(count)[:, None] * np.ones(3), 100)
    assert len(kept) == left
    assert len(np.unique(np.diff(kept[:, 0]))) == 1

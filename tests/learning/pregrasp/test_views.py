"""Pixels and places belong together; rates and best actions are what they say."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.affordance import CHANNELS, any_action, best_action, seen
from caretree.learning.pregrasp.hung_state import HungState, hang
from caretree.learning.pregrasp.oracle import DIRECT, corner_pixel
from caretree.learning.pregrasp.rate import signs, wilson
from caretree.learning.pregrasp.views import Views, direction_of, photograph


@pytest.fixture(scope="module")
def state() -> HungState:
    return hang(104)


@pytest.fixture(scope="module")
def views(state: HungState) -> Views:
    return photograph(state)


def test_a_pixel_s_place_lies_on_the_gown_and_in_that_pixel(state: HungState, views: Views) -> None:
    rng = np.random.default_rng(0)
    for view in range(6):
        spots = np.argwhere(views.depth[view] > 0)
        assert len(spots) > 300
        for row, column in spots[rng.permutation(len(spots))[:20]]:
            place = views.place(view, int(row), int(column))
            assert views.pixel(view, place) == (row, column)
            assert np.linalg.norm(state.vertices - place, axis=1).min() < 0.05
    with pytest.raises(ValueError, match="nothing of the gown"):
        views.place(0, 0, 0)


def test_views_are_thirty_degrees_apart() -> None:
    assert direction_of(0) @ direction_of(1) == pytest.approx(np.cos(np.pi / 6))
    assert direction_of(0) @ direction_of(3) == pytest.approx(0.0, abs=1e-12)


def test_the_corner_s_pixel_shows_the_corner_where_nothing_hides_it(state: HungState, views: Views) -> None:
    found = [(view, corner_pixel(state, views, view)) for view in range(6)]
    away = [np.linalg.norm(views.place(v, *at) - state.vertices[state.wanted]) for v, at in found if at is not None]
    assert min(away) < 0.03


def test_the_best_action_is_on_the_gown(views: Views) -> None:
    values = np.zeros((6, 3, *views.depth.shape[1:]), np.float32)
    row, column = (int(k) for k in np.argwhere(views.depth[4] > 0)[7])
    values[4, 0, row, column], values[3, DIRECT] = 0.9, 0.2
    values[2, 1, 0, 0] = 5.0  # where nothing of the gown shows
    best = best_action(values, views)
    assert (best.view, best.primitive, best.row, best.column) == (4, 0, row, column)
    only = best_action(values, views, grasp_only=True)
    assert (only.view, only.primitive) == (3, DIRECT)
    explored = any_action(np.random.default_rng(3), views, grasp_only=True)
    assert explored.primitive == DIRECT
    assert views.depth[explored.view, explored.row, explored.column] > 0


def test_what_is_seen_is_zero_off_the_gown(views: Views) -> None:
    image = seen(views)
    assert image.shape == (6, CHANNELS, *views.depth.shape[1:])
    assert image.dtype == np.float32
    off = views.depth == 0
    assert not image[:, :3].transpose(0, 2, 3, 1)[off].any()
    assert np.abs(image[:, 0]).max() < 6.0


def test_intervals_and_sign_tests() -> None:
    assert wilson(0, 0) == (0.0, 1.0)
    low, high = wilson(9, 10)
    assert (low, high) == (pytest.approx(0.596, abs=1e-3), pytest.approx(0.982, abs=1e-3))
    one, other = np.array([1, 1, 1, 1, 1, 1, 0], bool), np.zeros(7, bool)
    assert signs(one, other) == (6, 0, pytest.approx(2 / 64))

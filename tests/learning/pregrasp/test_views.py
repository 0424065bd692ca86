"""Pixels and places belong together; rates and best actions are what they say."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.learning.pregrasp.hung_state import HungState, hang
from caretree.learning.pregrasp.oracle import corner_pixel
from caretree.learning.pregrasp.photograph import photograph
from caretree.learning.pregrasp.rate import signs, wilson
from caretree.sim.pregrasp.affordance import CHANNELS, CORNER, any_action, best_action, seen, values_of, votes
from caretree.sim.pregrasp.numbers import DIRECT, VIEWS
from caretree.sim.pregrasp.views import Views, level


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
    assert level(0.0) @ level(VIEWS.turn) == pytest.approx(np.cos(np.pi / 6))
    assert level(0.0) @ level(3 * VIEWS.turn) == pytest.approx(0.0, abs=1e-12)


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


def test_all_places_are_those_of_their_pixels(views: Views) -> None:
    places, spots = views.places()
    assert len(places) == (views.depth > 0).sum()
    for place, spot in list(zip(places, spots.tolist(), strict=True))[::500]:
        assert np.allclose(place, views.place(*spot))


def test_views_vote_on_the_place_of_the_corner(state: HungState, views: Views) -> None:
    maps = np.full((6, CORNER + 1, *views.depth.shape[1:]), -9.0)
    corner = state.vertices[state.wanted].astype(float)
    places, spots = views.places()
    away = np.linalg.norm(places - corner, axis=1)
    shown = [view for view in range(6) if away[spots[:, 0] == view].min() < 0.02]
    assert len(shown) >= 3
    for view in shown:
        maps[(view, CORNER, *spots[np.where(spots[:, 0] == view, away, np.inf).argmin(), 1:])] = 9.0
    alone = tuple(int(k) for k in np.argwhere(views.depth[shown[0]] > 0)[0])  # at the holding hand, in one picture
    maps[(shown[0], CORNER, *alone)] = 9.0
    told = votes(maps, views)
    assert np.linalg.norm(places[told.argmax()] - corner) < 0.03
    assert told.max() <= 1.0
    best = best_action(values_of(maps, views), views)
    assert np.linalg.norm(views.place(best.view, best.row, best.column) - corner) < 0.03
    one = told[(spots == (shown[0], *alone)).all(axis=1)]
    assert 0.0 < float(one[0]) < told.max()


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

"""Cells around a grasp are those of the cloth before the hand, from whatever side it comes."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.sim.pregrasp.numbers import ACTION, VIEWS
from caretree.sim.pregrasp.surroundings import CELLS, surroundings, voted_corner
from caretree.sim.pregrasp.views import Views

MIDDLE = (40, 32)  # row and column


def patch(turn: float, side: int = 2) -> Views:
    """One picture of a small upright piece of cloth that faces it, and nothing else."""
    depth = np.zeros((1, VIEWS.height, VIEWS.width), np.float32)
    depth[0, MIDDLE[0] - side : MIDDLE[0] + side + 1, MIDDLE[1] - side : MIDDLE[1] + side + 1] = VIEWS.distance
    return Views(rgb=np.zeros((*depth.shape, 3), np.uint8), depth=depth, turns=np.array((turn,)))


def cells_of(views: Views) -> tuple[np.ndarray, np.ndarray]:
    corner = views.place(0, MIDDLE[0] + 1, MIDDLE[1])
    cells, corners = surroundings(views, corner, np.array(((0, *MIDDLE),)))
    return cells[0], corners[0]


@pytest.mark.parametrize("turn", [0.4, 2.0, -3.0])
def test_it_does_not_matter_from_where_the_hand_comes(turn: float) -> None:
    (here, corner), (there, other) = cells_of(patch(0.0)), cells_of(patch(turn))
    assert here.shape == (CELLS.up, CELLS.along, CELLS.across)
    assert np.abs(here - there).sum() <= 2 / CELLS.full  # a point on the border of two cells
    assert np.allclose(corner, other, atol=1e-6)


def test_cloth_lies_where_the_fingers_meet_it_and_the_corner_below() -> None:
    cells, corner = cells_of(patch(0.0))
    assert cells.sum() * CELLS.full == pytest.approx(25)
    along = cells.sum(axis=(0, 2))
    ahead = CELLS.along - int(np.ceil((CELLS.beyond + ACTION.depth) / CELLS.side))
    assert along[ahead - 1 : ahead + 2].sum() == pytest.approx(along.sum())
    assert (cells.sum(axis=(1, 2)) > 0).sum() >= 5  # of six layers, five pixels high
    assert corner == pytest.approx((-VIEWS.pixel, 0.0, -ACTION.depth), abs=2e-3)


def test_a_full_cell_is_not_filled_further() -> None:
    views = patch(0.0)
    six = Views(rgb=views.rgb.repeat(6, 0), depth=views.depth.repeat(6, 0), turns=np.zeros(6))
    cells, _ = cells_of(six)
    assert cells.max() == 1.0


def test_the_corner_is_where_most_votes_are() -> None:
    places = np.array(((0.0, 0.0, -0.8), (0.0, 0.02, -0.8), (0.5, 0.0, -0.8)))
    assert voted_corner(np.array((0.4, 0.4, 0.3)), places) == pytest.approx((0.0, 0.01, -0.8))
    assert voted_corner(np.array((0.1, 0.1, 0.9)), places) == pytest.approx((0.5, 0.0, -0.8))
    assert voted_corner(np.zeros(3), places) == pytest.approx((0.0, 0.01, -0.8))

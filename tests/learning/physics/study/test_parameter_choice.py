"""The tables of docs/garment-physics.md that compare candidates for the sixth parameter, on a small gown."""

import pytest
from caretree.learning.physics.study import parameter_choice

pytestmark = pytest.mark.usefixtures("small_cut")


def test_candidates_that_touch_nothing_move_nothing():
    moves = {one.name: one.moves for one in parameter_choice.candidates()}
    assert moves["friction x 2"] == moves["collision margin x 2"] == 0.0
    assert moves["air_drag x 2"] > 1.0
    assert list(moves.values()) == sorted(moves.values(), reverse=True)

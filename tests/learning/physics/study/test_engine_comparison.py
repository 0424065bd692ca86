"""The tables of docs/garment-physics.md that compare engines and candidates, on a small gown."""

import pytest
from caretree.learning.physics.study import engine_comparison as engines
from caretree.learning.physics.study import parameter_choice
from caretree.sim.scene.gown import GOWNS


@pytest.fixture(autouse=True)
def quick(monkeypatch, small_gown):
    monkeypatch.setitem(GOWNS, "medium", small_gown)


def test_engines_agree_best_where_they_solve_the_same_equations():
    same, clamped, rendered = engines.differences(gowns=1)
    assert same.worst < 0.5  # [mm]
    assert same.mean < clamped.mean
    assert rendered.depth < 20.0


def test_every_part_of_a_clip_has_its_cost():
    spent = engines.costs(gowns=1)
    assert list(spent) == ["static equilibrium", "fall", "15 depth pictures", "packing"]
    assert all(took >= 0 for took in spent.values())


def test_candidates_that_touch_nothing_move_nothing():
    moves = {one.name: one.moves for one in parameter_choice.candidates()}
    assert moves["friction x 2"] == moves["collision margin x 2"] == 0.0
    assert moves["air_drag x 2"] > 1.0
    assert list(moves.values()) == sorted(moves.values(), reverse=True)

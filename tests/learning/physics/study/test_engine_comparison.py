"""The tables of docs/garment-physics.md that compare the engines, on a small gown."""

import pytest
from caretree.learning.physics.study import engine_comparison as engines

pytestmark = pytest.mark.usefixtures("small_cut")


def test_engines_agree_best_where_they_solve_the_same_equations():
    same, clamped, rendered = engines.differences(gowns=1)
    assert same.worst < 0.5  # [mm]
    assert same.mean < clamped.mean
    assert rendered.depth < 20.0


def test_every_part_of_a_clip_has_its_cost():
    spent = engines.costs(gowns=1)
    assert list(spent) == ["static equilibrium", "fall", "15 depth pictures", "packing"]
    assert all(took >= 0 for took in spent.values())

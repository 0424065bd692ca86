"""Folds of a cloth that meets itself keep their order."""

import numpy as np
import pytest
from caretree.sim.bullet.soft_world import MARGIN
from caretree.sim.spring.layers import THICK, Layers
from caretree.sim.spring.sheet import Sheet
from caretree.sim.spring.solids import Solids

from .conftest import DT, block


def folded(towel, gap):
    """The towel with its half x > 0 turned back over the other one, `gap` above it [m]."""
    x = towel.vertices.copy()
    over = x[:, 0] > 1e-9
    x[over, 0] *= -1.0
    x[over, 2] += gap
    return x, over


@pytest.mark.parametrize("meets_itself", [True, False])
def test_the_upper_half_of_a_folded_towel_stays_upon_the_lower_one(client, towel, meets_itself):
    block(client, (2, 2, 0.1), (0, 0, -0.05))
    x, over = folded(towel, 0.03)
    sheet = Sheet(towel, x + (0, 0, MARGIN), DT, meets_itself)
    given = np.zeros((1, 7))
    solids = Solids(client, 1.0)
    for _ in range(800):
        sheet.step(solids, given)
    fold = np.abs(sheet.x[:, 0]) < 0.06  # there it stands up
    upper, lower = sheet.x[over & ~fold, 2], sheet.x[~over & ~fold, 2]
    assert lower.mean() == pytest.approx(MARGIN, abs=2e-3)
    if meets_itself:
        assert upper.min() > MARGIN + 0.5 * THICK
    else:
        assert upper.mean() == pytest.approx(MARGIN, abs=2e-3)


def test_what_is_near_stays_on_its_side_until_it_has_gone(towel):
    x, over = folded(towel, 0.01)
    layers = Layers(towel.vertices, towel.faces)
    layers.look(x, 0.015)
    assert len(layers.pairs) > 50
    vertex, face = layers.pairs[0]
    v = np.zeros_like(x)
    v[over, 2] = -2.0  # through within a step of 10 ms
    loose = np.ones(len(x))
    layers.part(x, v, loose, 0.01, 20)
    ahead = x + 0.01 * v
    away = np.abs(x[:, 0]) > 0.12  # from the fold, where they are neighbours
    assert (ahead[over & away, 2].min() - ahead[~over & away, 2].max()) > 0.5 * THICK
    x[over, 2] += 1.0
    layers.look(x, 0.015)
    assert not any((layers.pairs == (vertex, face)).all(axis=1))


def test_a_flat_cloth_has_nothing_to_part(towel):
    layers = Layers(towel.vertices, towel.faces)
    layers.look(towel.vertices, 0.015)
    assert len(layers.pairs) == 0

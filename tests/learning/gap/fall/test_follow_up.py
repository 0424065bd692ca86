"""Which drops are asked for next."""

import numpy as np
from caretree.learning.gap.fall.drop import fallen, height
from caretree.learning.gap.fall.experiment import HIGHEST
from caretree.learning.gap.fall.fit import Drop
from caretree.learning.gap.fall.follow_up import follow_up
from caretree.learning.gap.fall.search import rivals, search


def searched(gravity, top=20.0):
    t = np.arange(0.0, 1.95, 1.0 / 30.0)
    way = height(t, fallen(2.0, 0.0, 0.0, 0.0, gravity), top, 0.0)[0]
    noise = np.random.default_rng(2).normal(size=(3, len(t)))
    return search([Drop(name=f"d{k}", t=t, h=way + 0.01 * x) for k, x in enumerate(noise)], None, None)


def test_a_wrong_scale_and_lift_are_one_until_the_mass_differs():
    found = searched(9.81 * 0.95)
    named, others = found.best, rivals(found, found.best)
    assert {named.names, *(c.fit.names for c in others)} >= {("gain_error",), ("buoyancy",)}
    asked = follow_up(found, named, [c.fit for c in others])
    assert any(f.mass_factor != 1.0 for f in asked)
    assert asked[0].apart > 5.0
    assert all(0.0 < f.height_m <= HIGHEST for f in asked)
    assert len(asked) == 2


def test_a_body_is_not_dropped_from_the_clouds():
    found = searched(9.81 * 0.95, top=90.0)
    assert max(f.height_m for f in follow_up(found, found.best, [])) <= HIGHEST


def test_a_body_that_might_float_is_not_made_lighter():
    found = searched(9.81 * 0.45)  # lift of half its weight, or a scale that is wrong by as much
    others = [c.fit for c in rivals(found, found.best)]
    assert min(f.mass_factor for f in follow_up(found, found.best, others)) >= 1.0

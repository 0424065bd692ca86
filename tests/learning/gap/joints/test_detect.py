import numpy as np
import pytest
from caretree.learning.gap.joints.detect import smallest_found
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def test_the_smallest_size_is_a_size_of_the_effect_and_not_of_what_it_is_compared_with(axis_set):
    search = open_study(load_set(axis_set(lambda q, v, a: 6.0 * v))).named.search
    chosen = search.run()
    theta = search.fit(chosen)
    once, twice = (smallest_found(search, chosen, chosen[0], k * theta) for k in (1.0, 2.0))
    assert 0.0 < once < 1.0
    assert 2.0 * twice == pytest.approx(once, abs=0.03)
    assert smallest_found(search, chosen, chosen[0], 1e-6 * theta) == np.inf

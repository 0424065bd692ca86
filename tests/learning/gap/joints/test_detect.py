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


def test_what_would_have_been_seen_beside_something_far_larger_would_have_been_named(axis_set):
    def set_of(offset, name):
        return axis_set(lambda q, v, a: 60.0 * v + offset, noise=0.05, name=name)

    search = open_study(load_set(set_of(0.0, "without"))).named.search
    chosen = search.run()
    assert [search.blocks[i].name for i in chosen] == ["viscous_friction"]
    index = next(i for i, b in enumerate(search.blocks) if b.name == "offset")
    least = smallest_found(search, chosen, index, np.ones(1))
    for k, (factor, named) in enumerate([(0.5, False), (1.5, True)]):
        beside = open_study(load_set(set_of(factor * least, f"with{k}"))).named.search
        assert any(beside.blocks[i].name == "offset" for i in beside.run()) is named

import numpy as np
import pytest
from caretree.learning.gap.joints.alternatives import alternatives
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


@pytest.fixture
def dry(axis_set):
    """The search on a level of 0.8 N and an offset of 0.7 N, and the index of each block."""
    search = open_study(load_set(axis_set(lambda q, v, a: 0.8 * np.sign(v) + 0.7))).named.search
    return search, {b.name: i for i, b in enumerate(search.blocks) if not b.shape}


def names(search, chosen, index):
    return [frozenset(a.names) for a in alternatives(search, chosen, index)]


def test_friction_that_differs_with_the_direction_may_be_a_level_and_an_offset(dry):
    search, index = dry
    chosen = (index["asymmetric_friction"],)
    assert {"coulomb_friction", "offset"} in names(search, chosen, chosen[0])


def test_a_level_and_an_offset_may_be_friction_that_differs_with_the_direction(dry):
    search, index = dry
    chosen = (index["coulomb_friction"], index["offset"])
    assert all({"asymmetric_friction"} in names(search, chosen, i) for i in chosen)


def test_what_the_recordings_tell_apart_is_no_alternative(axis_set):
    search = open_study(load_set(axis_set(lambda q, v, a: 6.0 * v, noise=0.1))).named.search
    chosen = search.run()
    assert [search.blocks[i].name for i in chosen] == ["viscous_friction"]
    assert not {frozenset({n}) for n in ("spring", "offset", "coulomb_friction")} & set(
        names(search, chosen, chosen[0])
    )

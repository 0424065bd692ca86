"""Which bound a part of the body has."""

import pytest
from caretree.sim.evaluate.limits import force_limit
from caretree.sim.scene.person_spec import PERSON_PARTS


@pytest.mark.parametrize(
    ("part", "limit"),
    [("head", 65.0), ("neck", 150.0), ("neck_head", 65.0), ("left_upper_arm", 150.0), ("right_forearm", 160.0)],
)
def test_the_first_word_that_fits_sets_the_limit(part, limit):
    assert force_limit(part) == limit


def test_every_part_but_the_legs_has_a_limit():
    assert [part for part in PERSON_PARTS if force_limit(part) is None] == ["legs"]

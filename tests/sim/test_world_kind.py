"""Kinds of worlds by their names."""

import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.world_kind import DIFFICULTIES, WorldKind


@pytest.mark.parametrize("name", ["easy", *(f"easy+{one}" for one in DIFFICULTIES), "+".join(("easy", *DIFFICULTIES))])
def test_a_kind_has_what_its_name_says(name):
    kind = WorldKind.named(name)
    assert kind.name == name
    assert [one for one in DIFFICULTIES if kind.has(one)] == name.split("+")[1:]


def test_hard_is_all_there_is_and_is_written_out_for_the_record():
    assert WorldKind.named("hard").difficulties == DIFFICULTIES
    assert WorldKind.named(WorldKind.named("hard").name) == WorldKind.named("hard")
    assert WorldKind.named("hard").name != "hard"


@pytest.mark.parametrize(
    "name", ["", "heavy", "falling_arms", "easy+", "easy+wind", "hard+falling_arms", "easy+falling_arms+falling_arms"]
)
def test_what_is_no_kind_is_refused_with_those_there_are(name):
    with pytest.raises(CaretreeError, match=r"there are easy, hard.*falling_arms"):
        WorldKind.named(name)


def test_a_difficulty_that_does_not_exist_is_not_asked_for():
    with pytest.raises(CaretreeError, match="falling_arms"):
        WorldKind().has("wind")

import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.own.naming import name_own, none_of

from .slider import Slider
from .test_simulation import simulation


def test_the_set_is_found_and_its_values_are_those_of_a_fit_by_simulation():
    sim = simulation(hidden={"rate": 0.4, "size": 0.04})
    found = name_own(sim)
    assert {e.name for e in found.effects} == {"viscous", "ripple"}
    assert [b.name for b in found.named.blocks] == [e.name for e in found.effects]
    values = dict(zip([e.parameters[0].name for e in found.effects], found.named.theta, strict=True))
    assert values == {name: found.point.values[name] for name in values}
    assert values["rate"] == pytest.approx(0.4, rel=0.03)


def test_given_up_it_holds_nothing():
    sim = simulation(hidden={"rate": 0.4})
    found = none_of(name_own(sim), sim)
    assert found.effects == found.named.blocks == ()
    assert found.point.values == sim.none
    assert len(found.named.search.blocks) == len(Slider.effects)


class Deaf(Slider):
    name = "deaf"
    effects = Slider.effects[:2]

    def predict(self, log, values):
        return super().predict(log, {**values, "force": 0.0, "rate": 0.0})


def test_effects_that_change_nothing_are_an_error_of_the_class():
    with pytest.raises(GapError, match="Deaf: none of its effects changes"):
        name_own(simulation(Deaf()))

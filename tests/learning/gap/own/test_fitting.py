import numpy as np
import pytest
from caretree.learning.gap.own.fitting import best_start, first_set, fit

from .slider import Slider
from .test_simulation import simulation


def effects(*names):
    return tuple(e for e in Slider.effects if e.name in names)


def test_values_are_recovered_together():
    hidden = {"rate": 0.4, "slope": -0.2}
    sim = simulation(hidden=hidden)
    found = fit(sim, effects("viscous", "tilt"), sim.none, np.array([0.002]))
    for name, value in hidden.items():
        assert found.values[name] == pytest.approx(value, rel=0.03)
    assert found.values["force"] == 0.0


def test_a_value_stays_within_its_bounds():
    sim = simulation(hidden={"rate": -0.2})
    assert fit(sim, effects("viscous"), sim.none, sim.scale).values["rate"] == pytest.approx(0.0, abs=1e-5)


def test_a_start_is_the_size_that_leaves_least():
    sim = simulation(hidden={"rate": 0.6})
    assert best_start(sim, sim.none, effects("viscous")[0], sim.scale)["rate"] == pytest.approx(0.6)
    calm = simulation()
    assert best_start(calm, calm.none, effects("viscous")[0], calm.scale) == calm.none


def test_the_first_set_holds_what_matters_and_nothing_where_nothing_does():
    assert [e.name for e in first_set(simulation(hidden={"rate": 0.5})).effects] == ["viscous"]
    assert first_set(simulation()).effects == ()

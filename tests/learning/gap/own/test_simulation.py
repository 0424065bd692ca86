from typing import ClassVar

import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import set_of
from caretree.learning.gap.own.simulation import Simulation, recording

from caretree.gap import Effect, Parameter, System

from .slider import Slider, pushes


def simulation(system=None, **given):
    system = system or Slider()
    tables = pushes(**given)
    measured = set_of(system.name, tables[:-1], tables[-1:])
    return Simulation(system, [recording(e, system) for e in measured.fitted])


def test_a_start_of_its_own_is_fitted_to_each_recording_and_leaves_the_noise():
    sim = simulation(noise=0.002)
    starts = [sim.own(r, sim.none)["x0"] for r in sim.recordings]
    assert abs(starts[0] - starts[1]) > 0.01
    for r in sim.recordings:
        assert np.std(sim.left(r, sim.none)) == pytest.approx(0.002, rel=0.2)


class Aside(System):
    """Two channels that a start moves, the second one less, where the model errs by itself."""

    name = "aside"
    channels: ClassVar = {"x": "N", "y": "N"}
    effects = (Effect(name="pull", parameters=(Parameter(name="pull", unit="N", typical=1.0),)),)
    model_error: ClassVar = {"x": 0.2, "y": 0.2}
    start = (Parameter(name="drag", unit="mm", typical=1.0),)

    def predict(self, log, values):
        return np.outer(np.ones(len(log["t"])), (values["pull"] + 4.0 * values["drag"], values["drag"]))


def test_a_channel_that_is_predicted_well_outweighs_no_other_where_a_start_is_fitted():
    t = np.arange(100) / 15.0
    tables = [{"t": t, "x": np.full(100, 4.0 * drag), "y": np.full(100, drag - 0.2)} for drag in (0.1, 1.0, 0.5)]
    system = Aside()
    measured = set_of(system.name, tables[:2], tables[2:])
    sim = Simulation(system, [recording(e, system) for e in measured.fitted])
    # least squares has 0.2 / 17 of the error in y; over the gap of the first recording's y it would be off by more
    assert [sim.own(r, sim.none)["drag"] for r in sim.recordings] == pytest.approx([0.1 - 0.2 / 17, 1.0 - 0.2 / 17])


def test_columns_are_derivatives_without_what_the_start_could_do():
    sim = simulation(hidden={"rate": 0.3})
    effect, r = sim.system.effects[0], sim.recordings[0]
    at = {**sim.none, "rate": 0.3}
    column = sim.tangent(r, at, effect)
    assert column.shape == (len(r.t), 1, 1)
    moved = (sim.left(r, {**at, "rate": 0.29}) - sim.left(r, {**at, "rate": 0.31})) / 0.02
    np.testing.assert_allclose(column[:, :, 0], moved, atol=0.02 * np.abs(moved).max())
    assert abs(column.mean()) < 1e-6 * np.abs(column).max()


def test_the_same_question_is_asked_once():
    sim = simulation()
    r = sim.recordings[0]
    sim.raw(r, sim.none)
    calls = sim.calls
    sim.raw(r, sim.none)
    sim.raw(r, {**sim.none, "slope": 0.1})  # a regressor needs no simulation
    assert sim.calls == calls


class Raises(Slider):
    def predict(self, log, values):
        raise KeyError("torque\nis missing")


class Short(Slider):
    def predict(self, log, values):
        return np.zeros(3)


class Lost(Slider):
    def predict(self, log, values):
        return np.full(len(log["t"]), np.nan)


class Away(Slider):
    def predict(self, log, values):
        return np.full(len(log["t"]), 1e308)


class Exits(Slider):
    def predict(self, log, values):
        raise SystemExit("bye")


class Writes(Slider):
    def predict(self, log, values):
        log["x"][0] = 0.0
        return log["x"]


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        (Raises, "Raises.predict raised KeyError on fit_1"),
        (Short, r"Short.predict returned an array of shape \(3, 1\)"),
        (Lost, "Lost.predict is not finite"),
        (Away, "Away.predict is not finite, or huge,"),
        (Exits, "Exits.predict raised SystemExit on fit_1: bye"),
        (Writes, "Writes.predict raised ValueError"),
    ],
)
def test_what_a_users_code_does_wrong_is_one_sentence(kind, says):
    sim = simulation(kind())
    with pytest.raises(GapError, match=says) as error:
        sim.raw(sim.recordings[0], sim.none)
    assert "\n" not in str(error.value)


class Unstable(Slider):
    def predict(self, log, values):
        x = super().predict(log, values)
        return x if values["rate"] < 1.0 else np.full(len(x), np.inf)


def test_values_at_which_it_diverges_are_a_bad_fit_and_no_error():
    sim = simulation(Unstable())
    r = sim.recordings[0]
    left = r.measured - sim.raw(r, {**sim.none, "rate": 2.0})
    assert np.isfinite(left).all()
    assert np.abs(left).min() > 10 * np.abs(r.measured).max()


class Moody(Slider):
    def predict(self, log, values):
        return super().predict(log, values) + np.random.default_rng().normal()


def test_one_that_does_not_repeat_is_noticed():
    assert simulation().repeats()
    assert not simulation(Moody()).repeats()

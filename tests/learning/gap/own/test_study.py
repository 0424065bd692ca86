"""The rules of honesty hold for a simulator of one's own."""

import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.notebook import run

from .recorded import example, tables
from .slider import Plain, pushes
from .test_simulation import Moody


def asked(tables, kind=Plain):
    *fit, held = tables
    return run(kind, fit=fit, heldout=[held])


def test_an_effect_the_class_does_not_have_is_unknown_and_not_forced_into_one_it_has():
    result = asked(pushes(4, kind=Plain, extra=lambda log, k: 0.03 * np.sin(2.0 * np.pi * log["t"] / 1.7)))
    assert result.verdict.verdict == "unknown"
    assert result.verdict.guess


def test_what_makes_the_held_out_recording_worse_is_never_found():
    def only_while_fitting(log, k):
        return (0.05 if k < 3 else -0.05) * np.sin(3.0 * log["push"])

    result = asked(pushes(4, kind=Plain, extra=only_while_fitting))
    v = result.verdict
    assert v.verdict == "unknown"
    assert v.guess == "ripple on system would explain the fitted recordings and make the held-out ones worse"
    assert v.effects == v.recalibration == ()
    assert result.model["effects"] == []
    assert v.gap.after == v.gap.before


def test_two_effects_with_the_same_trace_are_told_as_equals():
    system = example("base")
    *fit, held = tables(system, {"turn_lost": 0.08})
    v = run(system, fit=fit, heldout=[held]).verdict
    found = (*v.effects, *v.recalibration)
    assert len(found) == 1
    assert {found[0].name, *found[0].equivalent} == {"turning_slip", "track_width"}
    assert "no experiment tried tells" in found[0].experiment


def test_a_simulator_that_does_not_repeat_is_refused():
    with pytest.raises(GapError, match=r"Moody.predict gives two answers"):
        asked(pushes(), Moody)


def test_a_burst_is_no_effect_of_the_class():
    def knock(log, k):
        return 0.1 * np.exp(-(((log["t"] - 3.0) / 0.08) ** 2)) if k == 0 else 0.0 * log["t"]

    v = asked(pushes(4, kind=Plain, extra=knock)).verdict
    assert v.verdict == "unknown"
    assert v.guess.startswith("a burst in x from 2.")
    assert [w.episode for w in v.where if w.effect == "contact"] == ["fit_1"]


def test_channels_of_several_units_are_compared_by_their_noise():
    system = example("base")
    *fit, held = tables(system, {"d_right": 0.0015})
    gap = run(system, fit=fit, heldout=[held]).verdict.gap
    assert gap.unit == "noise floors"
    assert gap.floor == pytest.approx(1.0)
    assert set(gap.channels) == {"x", "y", "yaw"}

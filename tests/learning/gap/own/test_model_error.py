"""An effect that is no larger than what the model leaves by itself is not named."""

from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.notebook import run
from caretree.learning.gap.own.model_error import deviations, faintest, least_sure
from caretree.learning.gap.own.system import check_system

from .slider import Plain, pushes

COLUMNS = (lambda t: np.ones_like(t), lambda t: t / t[-1], lambda t: np.sin(40.0 * t))


def block(*columns):
    """An effect on one channel, one parameter a column."""
    return SimpleNamespace(
        channels=(0,), parameters=columns, build=lambda log: np.stack([c(log.t) for c in columns], axis=1)[:, None]
    )


def logs(count, samples=300):
    t = np.linspace(0.0, 6.0, samples)
    return [SimpleNamespace(t=t, inner=slice(None)) for _ in range(count)]


@pytest.mark.parametrize("count", [1, 2, 8])
def test_it_is_as_large_as_slow_errors_make_it(count):
    given, made, rng = logs(count), [], np.random.default_rng(0)
    X = np.concatenate([np.stack([c(log.t) for c in COLUMNS], axis=1) for log in given])
    share = (np.arange(300) + 0.5) / 300
    shapes = np.stack([np.ones(300), *(np.sqrt(2.0) * np.cos(np.pi * n * share) for n in (1, 2))])
    for _ in range(3000):
        error = np.concatenate([0.4 / np.sqrt(3.0) * rng.standard_normal(3) @ shapes for _ in given])
        made.append(np.linalg.lstsq(X, error, rcond=None)[0])
    found = deviations([block(*COLUMNS[:2]), block(COLUMNS[2])], np.array((3.0,)), given, np.array((0.4,)))
    assert found == pytest.approx(np.std(made, axis=0), rel=0.06)


def test_a_model_without_error_of_its_own_leaves_none():
    assert deviations([block(*COLUMNS)], np.ones(1), logs(2), np.zeros(1)).tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("theta", "doubtful"),
    [((3.0, 0.1, 5.0), None), ((0.3, 0.1, 5.0), 0), ((3.0, 0.1, 1.0), 1), ((-3.0, 0.0, -2.5), None)],
)
def test_the_effect_that_is_least_above_it_goes_first(theta, doubtful):
    blocks = [block(*COLUMNS[:2]), block(COLUMNS[2])]
    assert least_sure(blocks, np.array(theta), np.ones(3)) == doubtful


def test_nothing_is_doubtful_where_nothing_is_named():
    assert least_sure([], np.zeros(0), np.zeros(0)) is None


@pytest.mark.parametrize("error", [{"x": -0.1}, {"x": float("nan")}, {"speed": 0.1}])
def test_an_error_that_is_no_size_of_a_channel_is_refused(error):
    system = Plain()
    system.model_error = error
    with pytest.raises(GapError, match="model_error"):
        check_system(system)


class Drifting(Plain):
    """A slider whose model leaves 3 cm, slow and another in every recording, and says so."""

    name = "drifting"
    model_error: ClassVar = {"x": 0.03}


def drift(log, k):
    share = (log["t"] - log["t"][0]) / 6.0
    a, b = np.random.default_rng([7, k]).normal(size=2)
    return 0.03 * (a + b * np.cos(np.pi * share))


def asked(kind, hidden=None):
    *fit, held = pushes(4, kind=kind, hidden=hidden, extra=drift)
    return run(kind, fit=fit, heldout=[held]).verdict


def test_what_the_model_leaves_by_itself_is_no_gap():
    assert asked(Plain).verdict != "adequate"
    found = asked(Drifting)
    assert (found.verdict, found.effects, found.recalibration) == ("adequate", (), ())


def test_what_is_well_above_it_is_named_with_an_interval_that_knows_of_it():
    (found,) = asked(Drifting, {"size": 0.2}).effects
    (value,) = found.parameters
    assert found.name == "ripple"
    assert value.low < 0.2 < value.high
    (narrow,) = (f for f in asked(Plain, {"size": 0.2}).effects if f.name == "ripple")
    assert value.high - value.low > narrow.parameters[0].high - narrow.parameters[0].low


def test_what_moves_less_than_the_model_errs_is_no_finding_however_fast_it_is():
    assert [f.name for f in asked(Plain, {"size": 0.03}).effects][-1] == "ripple"
    found = asked(Drifting, {"size": 0.03})
    assert (found.verdict, found.effects) == ("adequate", ())


def test_the_report_says_that_what_is_below_it_would_not_have_been_named():
    """Of a swing of 1 by a sine, 0.03 of a metre are root mean square from an amplitude of about 0.042 on."""
    *fit, held = pushes(4, kind=Drifting, extra=drift)
    told = run(Drifting, fit=fit, heldout=[held]).verdict.detectable["ripple on system"]
    assert float(told.split()[0]) > 0.03


def test_the_faintest_goes_first_where_no_channel_shows_it():
    blocks = [block(COLUMNS[0]), block(COLUMNS[2])]
    assert faintest(blocks, np.array((0.9, 1.0)), logs(2), np.array((1.0,))) == 1
    assert faintest(blocks, np.array((0.9, 2.0)), logs(2), np.array((1.0,))) == 0
    assert faintest(blocks, np.array((1.1, 2.0)), logs(2), np.array((1.0,))) is None
    assert faintest(blocks, np.array((1e-9, 2.0)), logs(2), np.zeros(1)) is None
    assert faintest([], np.zeros(0), logs(2), np.ones(1)) is None


def test_a_burst_is_one_only_above_what_the_model_leaves():
    def bump(size):
        return lambda log, k: size * (np.abs(log["t"] - 3.0) < 0.3) * (k == 0)

    def verdict(size):
        *fit, held = pushes(4, kind=Drifting, extra=bump(size))
        return run(Drifting, fit=fit, heldout=[held]).verdict.verdict

    assert verdict(0.02) == "adequate"
    assert verdict(0.2) == "unknown"


def test_what_one_recording_alone_shows_and_those_held_out_do_not_is_given_up():
    def once(log, k):
        return (k < 3) * drift(log, k) + (k == 0) * 0.12 * np.sin(3.0 * log["push"])

    named = []
    for kind in (Plain, Drifting):
        *fit, held = pushes(4, kind=kind, hidden={"rate": 0.4}, extra=once)
        v = run(kind, fit=fit, heldout=[held]).verdict
        named.append([f.name for f in v.effects])
    assert named == [["viscous", "ripple"], ["viscous"]]

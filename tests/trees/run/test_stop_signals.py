"""Signals ask a run for the safe stop, and where there is none they interrupt."""

import signal

import pytest
from caretree.skills.core.reasons import Reason
from caretree.trees.run import ticker
from caretree.trees.run.stop_signals import CAUSES, StopSignals

from ..planted import Plan, run_of

SIGNALS = [getattr(signal, name) for name in CAUSES]


@pytest.fixture
def run():
    return run_of(lambda context: Plan("p", context, outcomes=[True]))


@pytest.fixture(autouse=True)
def as_from_a_terminal():
    """Whoever runs the tests may ignore some of the signals."""
    before = {number: signal.signal(number, signal.SIG_DFL) for number in SIGNALS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", SIGNALS)
def test_without_a_run_a_signal_interrupts(number):
    with pytest.raises(KeyboardInterrupt), StopSignals(suspends=False):
        signal.raise_signal(number)


@pytest.mark.parametrize(
    ("number", "sentence"),
    [
        (signal.SIGINT, "The operator interrupted the run. [operator]"),
        (signal.SIGTERM, "The operator interrupted the run. [operator] the program was told to end (SIGTERM)"),
        (signal.SIGHUP, "The run can no longer be shown. [display] the terminal was closed (SIGHUP)"),
    ],
)
def test_the_first_signal_asks_for_the_safe_stop_and_says_why(run, number, sentence):
    with StopSignals() as signals:
        signals.run = run
        signal.raise_signal(number)
    result = run.run()
    assert (result.outcome, result.reason) == ("safe_stop", sentence)
    assert result.stopped_from_outside


def test_handlers_are_given_back_and_what_is_ignored_stays_ignored():
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    with StopSignals():
        signal.raise_signal(signal.SIGHUP)
        assert signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN


def test_only_ctrl_c_insists(run):
    with StopSignals() as signals:
        signals.run = run
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
            signal.raise_signal(number)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


def test_a_run_that_hangs_is_interrupted_by_the_second_signal(run, monkeypatch):
    with StopSignals() as signals:
        signals.run = run
        monkeypatch.setattr(ticker, "HANG", 0.0)
        signal.raise_signal(signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)


def test_the_first_reason_is_the_one_told(run):
    with StopSignals() as signals:
        signals.run = run
        signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGTERM)
    assert run.run().reason.startswith(Reason.DISPLAY_LOST.value)


def test_a_robot_that_moves_on_is_not_left_by_suspending_its_tree(run, monkeypatch):
    paused = []
    monkeypatch.setattr("os.kill", lambda process, number: paused.append(number))
    with StopSignals() as signals:
        signal.raise_signal(signal.SIGTSTP)
        signals.run = run
        signal.raise_signal(signal.SIGTSTP)
        assert paused == 2 * [signal.SIGSTOP], "a simulated robot stands still with its tree"
        monkeypatch.setattr(type(run), "time_waits", False)
        signal.raise_signal(signal.SIGTSTP)
    assert len(paused) == 2
    assert run.run().outcome == "safe_stop"

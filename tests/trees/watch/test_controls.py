"""A pause holds the run between two ticks until somebody ends it, or the run is told to stop."""

from __future__ import annotations

import pytest
from caretree.trees.watch import controls as module
from caretree.trees.watch.controls import Controls


@pytest.fixture(autouse=True)
def no_naps(monkeypatch):
    """The wall clock passes by itself, without anybody waiting for it."""
    now = [0.0]
    monkeypatch.setattr(module.time, "sleep", lambda nap: now.__setitem__(0, now[0] + nap))
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    return now


def waits(controls, now=0.0, ended=lambda: False, actions=()):
    """How often a tick has to wait; each wait performs the next of `actions`."""
    actions, count = list(actions), 0

    def meanwhile():
        nonlocal count
        count += 1
        assert count < 500, "it waits for ever"
        if actions:
            actions.pop(0)()

    controls.wait(now, ended, meanwhile)
    return count


def test_nothing_asked_for_is_no_wait():
    assert waits(Controls()) == 0


def test_a_pause_lasts_until_it_is_ended():
    controls = Controls()
    controls.pause()
    assert waits(controls, actions=[lambda: None, lambda: None, controls.go_on]) == 3
    assert waits(controls) == 0


def test_a_step_lets_one_tick_pass():
    controls = Controls()
    controls.step()
    assert waits(controls) == 0
    assert waits(controls, actions=[lambda: None, controls.step]) == 2
    assert controls.paused


def test_a_run_that_is_told_to_stop_is_not_held():
    controls = Controls()
    controls.pause()
    stopped = []
    assert waits(controls, ended=lambda: bool(stopped), actions=[lambda: stopped.append(1)]) == 1
    assert waits(controls, ended=lambda: True) == 0


def test_real_time_keeps_the_simulation_from_running_ahead(no_naps):
    controls = Controls()
    controls.live = True
    assert waits(controls, 0.0) == 0
    waits(controls, 1.0)
    assert no_naps[0] == pytest.approx(1.0, abs=0.11)
    no_naps[0] += 5.0  # the simulation is slow: it need not catch up, nor wait
    assert waits(controls, 1.1) == 0

"""A held arm is lowered before it is let go, whatever happens to those who watch and to the program."""

import contextlib
import errno
import itertools
import os
import signal
import sys

import numpy as np
import pytest
from caretree.sim.errors import DisplayError
from caretree.sim.record.spool import disk_error
from caretree.sim.world import GripperOpening, HandTwist
from caretree.skills.core.reasons import Reason
from caretree.trees.commands.run import show
from caretree.trees.run.runner import Run
from caretree.trees.run.stop_signals import StopSignals
from caretree.trees.run.task import load_task

from ..held_arm import FILE, LYING, put_down

MOMENTS = [1, 8, 20, 60, 110]  # steps of skills since the arm was taken: raised, held, held on
TROUBLES = {
    "event": ("RECORD_LOST", "the disk is full"),
    "frame": ("RECORD_LOST", "the disk is full"),
    "picture": ("RECORD_LOST", "the disk is full"),
    "stdout": ("DISPLAY_LOST", "nobody reads the output any more"),
    "view": ("DISPLAY_LOST", "the page is gone"),
    "button": ("INTERRUPTED", "the stop button"),
    "SIGTERM": ("INTERRUPTED", "SIGTERM"),
    "SIGHUP": ("DISPLAY_LOST", "the terminal was closed"),
}


class FullDisk:
    """A recorder on a disk that is full for some of what is recorded."""

    def __init__(self):
        self.full = set()
        self.refused = 0

    def begin(self, static):
        pass

    def event(self, event):
        self._write("event")

    def frame(self, truth):
        self._write("frame")

    def picture(self, t, image):
        self._write("picture")

    def watch(self, run):
        """A view that fails, or on which somebody presses the button."""
        if "view" in self.full:
            raise DisplayError("the page is gone")
        if "button" in self.full:
            run.request_stop(Reason.INTERRUPTED, "the stop button of the view was pressed", "operator")

    def _write(self, what):
        if what in self.full:
            self.refused += 1
            raise disk_error(OSError(errno.ENOSPC, "No space left on device"), f"writing {what}")


@contextlib.contextmanager
def piped_stdout():
    """Stdout is a pipe; whether its reader leaves is up to the test."""
    (read, write), before = os.pipe(), sys.stdout
    try:
        with open(read) as reader, open(write, "w") as sys.stdout:
            yield reader
    finally:
        sys.stdout = before


def stopped_at(moment, cause):
    """The run that `cause(run)` befell so many steps after the arm was taken, and what is left of the recorder."""
    task = load_task(str(FILE))
    world, _ = task.scripted(0)
    recorder = FullDisk()
    run = Run(task, world, recorder=recorder, on_progress=show, before_tick=lambda: recorder.watch(run))
    world.attach_recorder(recorder, run.lost)
    held = 0

    def observe(name, phase):
        nonlocal held
        held += run.guard.grip("left") == "arm"
        if held == moment:
            held += 1
            cause(run, recorder, reader)

    run.context.observers.append(observe)
    with StopSignals() as signals, piped_stdout() as reader:
        signals.run = run
        return run, run.run(), recorder


def strike(trouble, recorder, reader):
    """Let one trouble come about."""
    if trouble == "stdout":
        reader.close()
    elif trouble.startswith("SIG"):
        signal.raise_signal(getattr(signal, trouble))
    else:
        recorder.full.add(trouble)


def dropped(run):
    """Whether the arm was let go before it was down again."""
    return any(height > LYING + 0.01 for height in run.world.let_go_at)


def assert_put_down(run, result):
    assert run.world.let_go_at
    assert not dropped(run)
    assert put_down(run.trace.events)
    assert run.root.made_safe is True
    assert run.root.entered is False
    assert result.outcome == "safe_stop"
    assert result.stopped_from_outside
    assert run.context.errors == []


@pytest.mark.parametrize("moment", MOMENTS)
@pytest.mark.parametrize("trouble", TROUBLES)
def test_the_arm_is_put_down(trouble, moment):
    run, result, recorder = stopped_at(moment, lambda run, *others: strike(trouble, *others))
    assert_put_down(run, result)
    reason, detail = TROUBLES[trouble]
    assert run.trace.events[-1]["reason"] == reason
    assert detail in result.reason
    assert "\n" not in result.reason
    if recorder.full - {"view", "button"}:
        assert recorder.refused > 1, "it went on failing, and nobody minded"


def test_everything_at_once_and_again():
    def cause(run, *others):
        for trouble in [*TROUBLES, *TROUBLES]:
            strike(trouble, *others)
        # and on every step from now on
        run.context.observers.append(lambda name, phase: signal.raise_signal(signal.SIGHUP))

    run, result, _ = stopped_at(40, cause)
    assert_put_down(run, result)
    assert "SIGTERM" in result.reason


@pytest.mark.extra
def test_the_dressing_lowers_an_arm_before_it_lets_go():
    task = load_task("dressing")
    world, senses = task.scripted(100)
    run = Run(task, world, senses=senses, params=task.parameters("dress"))
    held = 0

    def observe(name, phase):
        nonlocal held
        held += run.guard.grip("left") == "arm"
        if held == 100:  # it is up, and its sleeve is sought
            signal.raise_signal(signal.SIGHUP)

    run.context.observers.append(observe)
    with StopSignals() as signals:
        signals.run = run
        result = run.run()
    assert (result.outcome, run.root.made_safe) == ("safe_stop", True)
    assert result.reason.startswith("The run can no longer be shown.")
    opened = max(n for n, sent in enumerate(world.sent) if isinstance(sent, GripperOpening) and sent.opening < 0.01)
    held_on = itertools.takewhile(lambda sent: not isinstance(sent, GripperOpening), world.sent[opened + 1 :])
    twists = [sent.twist_in_map[2] for sent in held_on if isinstance(sent, HandTwist) and sent.side == "left"]
    assert max(twists) > 0.0, "up"
    assert np.mean(twists[-15:]) < 0.0, "and down again before the next command to the fingers"


def test_only_an_operator_who_insists_makes_the_robot_let_go_at_once():
    def cause(run, *others):
        signal.raise_signal(signal.SIGINT)
        run.context.observers.append(
            lambda name, phase: signal.raise_signal(signal.SIGINT) if (name, phase) == ("lower", "step") else None
        )

    run, result, _ = stopped_at(40, cause)
    assert result.outcome == "safe_stop"
    assert run.root.made_safe is None
    assert dropped(run)
    assert not put_down(run.trace.events)

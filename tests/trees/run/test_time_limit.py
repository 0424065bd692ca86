"""Code that does not come back is interrupted where it stands, and the run still ends safely."""

import contextlib
import os
import signal
import subprocess
import sys
import threading

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.guard.limits import Limits
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.condition import Condition
from caretree.trees.nodes.decorators import FailSafe
from caretree.trees.proof.leaves import leaf_findings
from caretree.trees.run import task as task_module
from caretree.trees.run import time_limit
from caretree.trees.run.task import TaskError, load_task
from caretree.trees.run.time_limit import TimeLimit, TookTooLongError
from caretree.trees.run.trace import paths_of

from ..planted import Look, Release, run_of

SHORT = 0.05  # [s] what hangs is not waited for longer


def spin(*unused):
    while True:
        pass


def swallow():
    while True:
        with contextlib.suppress(Exception):
            spin()


class Spins(Skill):
    """Never gives its tick back."""

    def steps(self):
        yield
        spin()


class SpinsAtItsEnd(Skill):
    """Never comes back from being stopped."""

    def steps(self):
        yield from self.wait(100.0)

    def cancel(self):
        spin()


class SpinsWhileStopping(SpinsAtItsEnd):
    """The same, but only the second time that it is asked."""

    asked = 0

    def cancel(self):
        self.asked += 1
        return False if self.asked == 1 else spin()


@pytest.mark.parametrize("code", [spin, swallow])
def test_what_does_not_come_back_is_interrupted_and_its_place_told(code):
    told = rf"did not come back within {SHORT} s \(at test_time_limit.py:"
    with pytest.raises(TookTooLongError, match=told), TimeLimit(SHORT):
        code()


def test_a_limit_around_a_limit_goes_on_afterwards():
    before = signal.getsignal(signal.SIGALRM)

    def nested():
        with TimeLimit(100.0):
            pass
        spin()

    with pytest.raises(TookTooLongError, match=r"within 0.2 s"), TimeLimit(0.2):
        nested()
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_what_is_started_again_has_its_whole_time_again(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(time_limit.time, "perf_counter", lambda: now[0])
    with TimeLimit(10.0) as limit:
        now[0] = 9.0
        limit.start()
        now[0] = 18.0
        signal.raise_signal(signal.SIGALRM)
        limit.pause()
        now[0] = 1000.0
        signal.raise_signal(signal.SIGALRM)
        limit.start()
        now[0] = 1011.0
        with pytest.raises(TookTooLongError):
            signal.raise_signal(signal.SIGALRM)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
def test_it_holds_in_a_fork_too():
    with TimeLimit(SHORT) as limit:
        limit.pause()
        fork = os.fork()
        if fork == 0:
            try:
                limit.set_alarm()
                limit.start()
                spin()
            except TookTooLongError:
                os._exit(3)
            finally:
                os._exit(1)
        _, status = os.waitpid(fork, 0)
    assert os.waitstatus_to_exitcode(status) == 3


def test_a_debugger_is_left_alone(monkeypatch):
    monkeypatch.setattr(time_limit, "DEBUGGERS", (__name__.partition(".")[0],))
    now = [0.0]
    monkeypatch.setattr(time_limit.time, "perf_counter", lambda: now[0])
    with TimeLimit(10.0):
        now[0] = 100.0
        signal.raise_signal(signal.SIGALRM)


def test_in_another_thread_there_is_no_limit():
    done = []

    def work():
        with TimeLimit(SHORT):
            done.append(signal.getitimer(signal.ITIMER_REAL))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [(0.0, 0.0)]


def test_code_that_swallows_every_interrupt_ends_the_program():
    code = """
from caretree.trees.run import time_limit
time_limit.AGAIN = 0.01
def stubborn():
    while True:
        try:
            while True:
                pass
        except BaseException as error:
            caught = error
with time_limit.TimeLimit(0.01, lambda: print("put down")):
    stubborn()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (1, "put down\n")
    assert done.stderr.startswith("caretree: the task: it did not come back within 0.01 s")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("kind", [Spins, SpinsAtItsEnd, SpinsWhileStopping])
def test_a_skill_that_hangs_ends_in_the_safe_stop(kind):
    def build(context):
        return FailSafe("safely", kind("hang", context), Release("let go", context))

    run = run_of(build, limits=Limits(tick=SHORT, run=1.0))
    result = run.run()
    assert result.outcome == "safe_stop"
    assert run.root.made_safe is True
    assert any("TookTooLongError" in error for error in run.context.errors)
    if kind is Spins:
        assert "[hang] it did not come back within 0.05 s (at test_time_limit.py:" in result.reason
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_a_safe_branch_that_hangs_is_followed_by_the_last_resort():
    def build(context):
        return FailSafe("safely", Look("look", context, outcomes=[ValueError("x")]), Spins("let go", context))

    result = run_of(build, limits=Limits(tick=SHORT)).run()
    assert result.outcome == "safe_stop"


def test_a_condition_that_hangs_is_found_by_check(monkeypatch):
    monkeypatch.setattr("caretree.trees.proof.leaves.LOADING", SHORT)
    found = []

    def build(context):
        root = sequence("s", Condition("c", spin), Look("look", context, outcomes=[True]))
        found.extend(leaf_findings(root, context, paths_of(root)))
        return root

    run_of(build)
    assert len(found) == 1
    assert found[0].startswith("s/c: asked on the scripted world, it did not come back within 0.05 s")


@pytest.mark.parametrize(
    "text",
    ["while True:\n    pass\n", "def build(context):\n    while True:\n        pass\n"],
)
def test_a_task_file_that_hangs_is_refused_with_its_line(tmp_path, monkeypatch, text):
    monkeypatch.setattr(task_module, "LOADING", SHORT)
    (tmp_path / "hangs.py").write_text(text)
    with pytest.raises(TaskError, match=r"hangs.py:\d: it did not come back within 0.05 s"):
        run_of(load_task(str(tmp_path / "hangs.py")).build)

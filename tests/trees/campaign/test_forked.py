"""Forked runs are processes of their own: waited for, asked to end and killed like any other."""

import os
import signal
import subprocess
import threading
import time

import pytest
from caretree.trees.campaign import trial as trial_module
from caretree.trees.campaign.forked import ForkedRun
from caretree.trees.campaign.trial import run_trial

SCRIPTED = ("--world", "scripted")
HANGS = """
import signal, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print("hangs", flush=True)
time.sleep(600)
"""


@pytest.fixture
def hangs(tmp_path):
    """A task whose own code does not come back, and does not end when it is asked to."""
    path = tmp_path / "hangs.py"
    path.write_text(HANGS)
    return str(path)


def begun(run: ForkedRun, log) -> None:
    """Wait until the task's own code is at work."""
    while "hangs" not in (log.read_text() if log.exists() else ""):
        assert run.poll() is None, log.read_text()
        time.sleep(0.01)


@pytest.mark.extra
def test_a_scripted_trial_is_forked_and_kept_with_its_record_and_log(tmp_path):
    folder = tmp_path / "campaign" / "overall" / "seed-0003"
    trial = run_trial("wave", 3, folder, SCRIPTED, patience=60.0, stop=threading.Event(), key="now")
    assert (trial.outcome, trial.seed, trial.key) == ("success", 3, "now")
    assert (folder / "report.html").exists()
    assert "success: The task is done." in folder.with_name("seed-0003.log").read_text()


def test_children_are_told_to_take_one_thread_each(tmp_path, monkeypatch):
    started = {}
    monkeypatch.setattr(trial_module, "ForkedRun", lambda arguments, log, environment: started.update(environment))
    trial_module._started(("run", "wave", *SCRIPTED), tmp_path / "log")
    assert started == trial_module.ONE_THREAD
    started.clear()
    monkeypatch.setattr(trial_module.subprocess, "Popen", lambda command, env, **others: started.update(env))
    trial_module._started(("run", "wave"), tmp_path / "log")
    assert started.items() >= trial_module.ONE_THREAD.items()
    assert set(trial_module.ONE_THREAD.values()) == {"1"}


def test_a_trial_that_hangs_is_killed_and_counts_as_timeout(tmp_path, hangs, monkeypatch):
    monkeypatch.setattr(trial_module, "ENDING", 0.2)
    folder = tmp_path / "campaign" / "overall" / "seed-0000"
    trial = run_trial(hangs, 0, folder, SCRIPTED, patience=0.5, stop=threading.Event())
    assert (trial.outcome, trial.reason) == ("timeout", "no end within 0.5 s")


def test_a_run_has_a_session_of_its_own_and_tells_the_signal_that_killed_it(tmp_path, hangs):
    log = tmp_path / "log"
    run = ForkedRun(("run", hangs, *SCRIPTED, "--out", str(tmp_path / "out")), log, {"OMP_NUM_THREADS": "1"})
    begun(run, log)
    with pytest.raises(subprocess.TimeoutExpired):
        run.wait(timeout=0.01)
    process = run._process.pid
    assert os.getsid(process) == process
    run.terminate()
    with pytest.raises(subprocess.TimeoutExpired):
        run.wait(timeout=0.05)
    run.kill()
    assert run.wait(timeout=30.0) == -signal.SIGKILL
    assert run.poll() == -signal.SIGKILL


def test_bad_input_is_told_by_the_exit_status_and_the_log(tmp_path):
    log = tmp_path / "log"
    run = ForkedRun(("run", "no_such_task", *SCRIPTED), log, {})
    assert run.wait(timeout=60.0) == 2
    assert "unknown task 'no_such_task'" in log.read_text()

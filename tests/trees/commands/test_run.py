"""`caretree run` in a process of its own, which loses its terminal, its reader, its disk, or is told to end."""

import json
import os
import re
import signal
import subprocess
import sys

import pytest

from ..held_arm import FILE, put_down

# what the shell would set up before the command
IN_A_TERMINAL = "os.login_tty(0)"
ON_A_SMALL_DISK = "resource.setrlimit(resource.RLIMIT_FSIZE, (1100000, 1100000))"
HEARING = "[signal.signal(number, signal.SIG_DFL) for number in (signal.SIGHUP, signal.SIGTERM)]"
CODE = "import os, resource, signal, sys; {}; from caretree.trees.cli import main; sys.exit(main(sys.argv[1:]))"


def started(tmp_path, first, **streams):
    """A run that holds an arm, in folder r."""
    command = [sys.executable, "-c", CODE.format(first), "run", str(FILE), "--world", "scripted", "--out", "r"]
    return subprocess.Popen(command, cwd=tmp_path, **{"stderr": subprocess.PIPE, **streams})


def until_held(lines):
    """Read what is shown until the arm is held."""
    for line in lines:
        if b" x hold" in line:
            return
    raise AssertionError("the run ended before it held the arm")


def assert_put_down(tmp_path, reason):
    """The record is whole: it shows how the arm was put down, and says why."""
    folder = tmp_path / "r"
    record = json.loads((folder / "run.json").read_text())
    assert record["outcome"] == "safe_stop"
    assert re.fullmatch(reason, record["reason"])
    assert record["stopped_from_outside"]
    events = [json.loads(line) for line in (folder / "trace.jsonl").read_text().splitlines()]
    assert put_down(events)
    assert events[-1]["kind"] == "end"
    assert {"report.html", "truth.npz", "video.mp4"} <= {path.name for path in folder.iterdir()}
    assert not (folder / "reserve").exists()


@pytest.mark.extra
@pytest.mark.parametrize(
    ("number", "reason"),
    [
        (signal.SIGTERM, "The operator interrupted the run. [operator] the program was told to end (SIGTERM)"),
        (signal.SIGHUP, "The run can no longer be shown. [display] the terminal was closed (SIGHUP)"),
    ],
)
def test_a_signal_puts_the_arm_down(tmp_path, number, reason):
    with started(tmp_path, HEARING, stdout=subprocess.PIPE) as run:
        until_held(run.stdout)
        run.send_signal(number)
        run.send_signal(number)
        out, error = run.communicate()
    assert (run.returncode, error) == (1, b"")
    assert f"safe stop: {reason}".encode() in out.splitlines()
    assert_put_down(tmp_path, re.escape(reason))


@pytest.mark.extra
def test_a_reader_that_leaves_puts_the_arm_down(tmp_path):
    with started(tmp_path, HEARING, stdout=subprocess.PIPE) as run:
        until_held(run.stdout)
        run.stdout.close()
        error = run.stderr.read()
    assert (run.returncode, error) == (1, b"")
    assert_put_down(tmp_path, r"The run can no longer be shown\. \[display\] nobody reads the output any more")


@pytest.mark.extra
@pytest.mark.skipif(not hasattr(os, "login_tty"), reason="no terminals on this system")
@pytest.mark.parametrize(
    "hearing", [HEARING, "signal.signal(signal.SIGHUP, signal.SIG_IGN)"], ids=["it is told", "it finds out"]
)
def test_a_terminal_that_is_closed_puts_the_arm_down(tmp_path, hearing):
    ours, theirs = os.openpty()
    both = f"{IN_A_TERMINAL}; {hearing}"
    with started(tmp_path, both, stdin=theirs, stdout=theirs, stderr=theirs) as run:
        os.close(theirs)
        with open(ours, "rb", buffering=0) as terminal:
            until_held(terminal)
        assert run.wait() == 1
    # whichever comes first, the signal or a line that cannot be printed
    assert_put_down(tmp_path, r"The run can no longer be shown\. \[display\] the terminal was closed( \(SIGHUP\))?")


@pytest.mark.extra
def test_a_disk_that_takes_no_more_puts_the_arm_down(tmp_path):
    with started(tmp_path, ON_A_SMALL_DISK, stdout=subprocess.PIPE) as run:
        out, error = run.communicate()
    sentence = r"recording frame \d+ in r/truth.spool failed: File too large"
    reason = rf"The record can no longer be written\. \[recorder\] {sentence}"
    assert run.returncode == 2
    assert re.fullmatch(rf"caretree: {sentence}\n", error.decode())
    assert re.search(rf"^safe stop: {reason}$", out.decode(), re.M)
    assert_put_down(tmp_path, reason)

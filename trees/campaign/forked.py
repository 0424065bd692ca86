"""Runs of a campaign forked from a process that has loaded everything: a scripted run takes less time than loading.

Each run is still a process, and a session, of its own: it can be asked to end, killed and waited for as one that was
started anew, its crash is its own, and it ends when its campaign is gone.  The process that forks does nothing else,
so no thread and no lock of the campaign is in the copies.
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from multiprocessing import forkserver
from pathlib import Path

_STARTING = threading.Lock()


class ForkedRun:
    """`caretree ARGUMENTS` in a fork of the loaded process; waited for and ended like a `subprocess.Popen`.

    Args:
        arguments: of the command line.
        log: file that gets all output.
        environment: variables for the process that forks; the first run of a campaign decides.
    """

    def __init__(self, arguments: Sequence[str], log: Path, environment: Mapping[str, str]) -> None:
        context = multiprocessing.get_context("forkserver")
        with _STARTING:
            _start_server(environment)
            self._process = context.Process(target=_live, args=(tuple(arguments), str(log)), daemon=False)
            self._process.start()

    def poll(self) -> int | None:
        """Exit status, below 0 for a signal; None while it runs."""
        return self._process.exitcode

    def wait(self, timeout: float | None = None) -> int:
        """Exit status, once it has ended.

        Raises:
            subprocess.TimeoutExpired: it has not within `timeout` [s].
        """
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired("caretree", timeout or 0.0)
        return self._process.exitcode

    def terminate(self) -> None:
        """Ask it to end, in the safe stop."""
        self._process.terminate()

    def kill(self) -> None:
        """End it."""
        self._process.kill()


def _start_server(environment: Mapping[str, str]) -> None:
    """Start the process that forks, once in this process; libraries read these variables when they are loaded."""
    multiprocessing.get_context("forkserver").set_forkserver_preload([f"{__package__}.loaded"])
    before = {name: os.environ.get(name) for name in environment}
    os.environ.update(environment)
    try:
        forkserver.ensure_running()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _live(arguments: Sequence[str], log: str) -> None:
    """The life of a forked run."""
    from .child import run_watched

    os.setsid()  # the terminal's Ctrl-C reaches only the campaign
    output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    sys.stdout.flush()
    for stream in (1, 2):
        os.dup2(output, stream)
    os.close(output)
    sys.argv = ["caretree", *arguments]
    sys.exit(run_watched(os.getppid()))

"""Processes that fork from each other and report to the one that began, a limited number of them at work at once.

A fork goes on where its parent stood, with a copy of all that the parent had, in the middle of whatever it did.  Where
there is a free slot the two go on side by side; where there is none the parent lends its own slot and waits until the
fork is done or another slot is free.  So there are few more processes than the work is deep, and as many at work as
there are slots.

| what ends | what happens |
|---|---|
| one of them is killed, or crashes | its own reports are missing; its slot is given back by its parent |
| who began (Ctrl-C, an error, nobody asks for more) | kills all of them; what was reported before counts |
| who began is killed | each ends at its next fork or report |
"""

from __future__ import annotations

import contextlib
import fcntl
import gc
import os
import select
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator

SLOT = b"."


class ForkTree:
    """Forks of this process.

    Args:
        jobs: processes at work at once.
    """

    def __init__(self, jobs: int = 1) -> None:
        self._jobs = jobs
        self._children: dict[int, bool] = {}  # process -> whether it has a slot of its own
        self._lent: int | None = None  # by the parent, which waits at the other end of this pipe to have its slot back
        self._reading = self._writing = -1
        self._slots = (-1, -1)
        self._turn = -1  # locked by whoever reports

    def reports(self, work: Callable[[], None]) -> Iterator[str]:
        """Do the work in a fork, which may `fork` further and `report`; every report as it comes, one line each."""
        with contextlib.ExitStack() as stack:
            self._reading, self._writing = os.pipe()
            self._slots = os.pipe()
            for file in (self._reading, *self._slots):
                stack.callback(os.close, file)
            os.set_blocking(self._slots[0], False)
            os.write(self._slots[1], SLOT * (self._jobs - 1))
            self._turn = stack.enter_context(tempfile.TemporaryFile()).fileno()
            _flush()
            first = os.fork()
            if first == 0:
                self._live(work)
            os.close(self._writing)
            stack.callback(self._end_all, first)
            yield from self._lines()

    def fork(self) -> bool:
        """Fork: True in the new process, False in the one that goes on, at once or when the other is done."""
        if _nobody_reads(self._writing):
            os._exit(0)
        self._reap(os.WNOHANG)
        side_by_side = self._take_slot()
        done, lent = (-1, -1) if side_by_side else os.pipe()
        _flush()
        child = os.fork()
        if child == 0:
            gc.freeze()  # what is never looked at again stays shared
            if self._lent is not None:
                os.close(self._lent)
            if not side_by_side:
                os.close(done)
            self._children, self._lent = {}, None if side_by_side else lent
            return True
        if not side_by_side:
            os.close(lent)
            side_by_side = self._wait(done)
            os.close(done)
        self._children[child] = side_by_side
        return False

    def report(self, line: str) -> None:
        """Tell the process that began one line."""
        text = f"\n{line}\n".encode()  # what somebody who was killed had begun ends here
        with self._alone():
            while text:
                text = text[os.write(self._writing, text) :]

    def _live(self, work: Callable[[], None]) -> None:
        """The life of every fork: they all come back here from where they were forked.  It does not return."""
        try:
            if not self._children:
                os.setpgid(0, 0)  # the terminal's Ctrl-C reaches only who began
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_DFL)
            os.close(self._reading)
            gc.freeze()
            work()
        except BrokenPipeError:
            pass
        except BaseException:
            traceback.print_exc()
        finally:
            with contextlib.suppress(OSError, ValueError):
                _flush()
            self._give_slot_back()
            with contextlib.suppress(ChildProcessError):
                while True:
                    self._reap(0)
            os._exit(0)

    def _take_slot(self) -> bool:
        try:
            return bool(os.read(self._slots[0], 1))
        except BlockingIOError:
            return False

    def _wait(self, done: int) -> bool:
        """Wait until a fork gives the slot back that it was lent; True when another was free first, which is taken."""
        while True:
            if not _readable(done, self._slots[0]):
                continue
            with self._alone():
                if _readable(done, timeout=0):
                    return False
                if self._take_slot():
                    return True

    def _give_slot_back(self) -> None:
        with self._alone():
            if self._lent is not None:
                try:
                    os.write(self._lent, SLOT)
                    return
                except BrokenPipeError:  # the parent has found another one
                    pass
            os.write(self._slots[1], SLOT)

    @contextlib.contextmanager
    def _alone(self) -> Iterator[None]:
        """While no other of the processes is here; one that is killed here leaves."""
        fcntl.lockf(self._turn, fcntl.LOCK_EX)
        try:
            yield
        finally:
            fcntl.lockf(self._turn, fcntl.LOCK_UN)

    def _reap(self, how: int) -> None:
        """Take note of children that have ended.

        Raises:
            ChildProcessError: `how` waits for one, and there is none.
        """
        while self._children or how == 0:
            child, status = os.waitpid(-1, how)
            if child == 0:
                return
            had_slot = self._children.pop(child, False)
            if had_slot and os.waitstatus_to_exitcode(status) != 0:  # else it has done so itself
                os.write(self._slots[1], SLOT)

    def _end_all(self, first: int) -> None:
        """Kill all that are left, and come back when they are gone, with whatever they have inherited from here."""
        for kill in (os.killpg, os.kill):  # it may not have had the time to make the group
            with contextlib.suppress(ProcessLookupError, PermissionError):
                kill(first, signal.SIGKILL)
        while os.read(self._reading, 1 << 16):
            pass
        os.waitpid(first, 0)

    def _lines(self) -> Iterator[str]:
        rest = b""
        while block := os.read(self._reading, 1 << 16):
            *lines, rest = (rest + block).split(b"\n")
            yield from (line.decode(errors="replace") for line in lines if line)


def _readable(*pipes: int, timeout: float | None = None) -> bool:
    """Whether there is something to read, or an end, in one of them; waits for it, or for `timeout` [s]."""
    poll = select.poll()
    for pipe in pipes:
        poll.register(pipe, select.POLLIN)
    return bool(poll.poll(None if timeout is None else 1000.0 * timeout))


def _nobody_reads(pipe: int) -> bool:
    poll = select.poll()
    poll.register(pipe, 0)
    return any(event & select.POLLERR for _, event in poll.poll(0))


def _flush() -> None:
    """What is still to be printed must not be in the copies."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()

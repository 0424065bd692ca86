"""A limit of wall time for code that a user wrote: what does not come back is interrupted where it stands.

| the code | what happens |
|---|---|
| loops, sleeps or waits for input | `TookTooLongError` is raised inside it |
| catches even that, and goes on | the same every second; the third time the program ends with exit status 1 |
| holds the interpreter (a library's own loop) | nothing, until it comes back |

The limit works by SIGALRM, so in the main thread only; elsewhere, and where a system has no such signal, there is none.
A debugger that waits for its user is left alone.
"""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any

from py_trees.behaviour import Behaviour

LOADING = 60.0  # [s] for a task's own code to be loaded and its tree to be built: imports take a few
AGAIN = 1.0  # [s] between two interrupts of the same code
INTERRUPTS_MAX = 3
DEBUGGERS = ("bdb", "pdb", "_pydevd_bundle")
LIBRARIES = (sys.prefix, sys.base_prefix, "<")  # where code lies that no task brings


class TookTooLongError(BaseException):
    """Raised inside code that does not come back; no `except Exception` of that code stops it.

    Attributes:
        node: name of the node of the tree that was at work; empty outside a tree.
    """

    def __init__(self, seconds: float, place: str, node: str = "") -> None:
        super().__init__(f"it did not come back within {seconds:g} s (at {place})")
        self.node = node


class TimeLimit:
    """Interrupts what is started while it is entered, if it lasts too long.

    Args:
        seconds: of wall time.
        on_ignored: called before the program ends because the code cannot be interrupted.
    """

    def __init__(self, seconds: float, on_ignored: Callable[[], object] = lambda: None) -> None:
        self._seconds = self._allowed = seconds
        self._on_ignored = on_ignored
        self._ends = math.inf
        self._interrupts = 0
        self._before: Any = None
        self._timer = (0.0, 0.0)
        self._active = False

    def __enter__(self) -> TimeLimit:
        """Begin to count; a limit around this one waits meanwhile."""
        if hasattr(signal, "SIGALRM") and threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGALRM, self._ring)
            self._timer = signal.setitimer(signal.ITIMER_REAL, self._seconds)
            self._active = True
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the alarm back."""
        if self._active:
            self._active = False
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, self._before)
            signal.setitimer(signal.ITIMER_REAL, *self._timer)

    def start(self, seconds: float | None = None) -> None:
        """Count from now on, to another limit [s] where one is given."""
        self._allowed = self._seconds if seconds is None else seconds
        self._ends, self._interrupts = time.perf_counter() + self._allowed, 0
        if self._active and self._allowed < self._seconds:
            signal.setitimer(signal.ITIMER_REAL, self._allowed)

    def set_alarm(self) -> None:
        """Have the alarm ring in this process too: a fork inherits none."""
        if self._active:
            signal.setitimer(signal.ITIMER_REAL, self._allowed)

    def pause(self) -> None:
        """What comes now may take as long as it likes."""
        self._ends = math.inf

    def _ring(self, number: int, frame: FrameType | None) -> None:
        """The timer is not set anew for each start, which would cost every tick: here is seen what is left."""
        left = self._ends - time.perf_counter()
        if left > 0 or any(_module(each) in DEBUGGERS for each in _outwards(frame)):
            signal.setitimer(signal.ITIMER_REAL, min(max(left, AGAIN / 10), self._seconds))
            return
        self._interrupts += 1
        signal.setitimer(signal.ITIMER_REAL, AGAIN)
        error = TookTooLongError(self._allowed, _place(frame), _node(frame))
        if self._interrupts > INTERRUPTS_MAX:
            self._end(error)
        raise error

    def _end(self, error: TookTooLongError) -> None:
        self._interrupts = 0  # what is done now may be interrupted too
        self._on_ignored()
        print(f"caretree: {error.node or 'the task'}: {error}, and cannot be interrupted", file=sys.stderr, flush=True)
        os._exit(1)


def _outwards(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def _module(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]


def _place(frame: FrameType | None) -> str:
    """`file:line` of the innermost code that is no library's, else of the innermost."""
    frames = list(_outwards(frame))
    own = [each for each in frames if not each.f_code.co_filename.startswith(LIBRARIES)]
    chosen = next(iter(own or frames), None)
    return f"{Path(chosen.f_code.co_filename).name}:{chosen.f_lineno}" if chosen else "?"


def _node(frame: FrameType | None) -> str:
    """The innermost node of a tree at work."""
    nodes = (each.f_locals.get("self") for each in _outwards(frame))
    return next((node.name for node in nodes if isinstance(node, Behaviour)), "")

"""Signals that end a run: they ask for the safe stop between two ticks, as no tick may be torn apart.

| signal | what it means | the first one | the next ones |
|---|---|---|---|
| SIGINT | Ctrl-C | asks for the safe stop | the operator insists: `KeyboardInterrupt` |
| SIGTERM | somebody ends the program | asks for the safe stop | nothing, or `KeyboardInterrupt` if the run hangs |
| SIGHUP | the terminal was closed | asks for the safe stop | nothing, or `KeyboardInterrupt` if the run hangs |
| SIGQUIT | Ctrl-backslash | as SIGTERM | as SIGTERM |
| SIGTSTP | Ctrl-Z | as SIGTERM where time passes by itself: who stands still cannot stop a robot | as SIGTERM |

Where there is no run to make safe, each of them but SIGTSTP raises `KeyboardInterrupt`.  During a run that has the
runner make safe, during the safe branch it has the runner open the fingers.  One that is ignored from the start, as
`nohup` has it, stays ignored.  The loss of a reader (SIGPIPE) shows as an error of printing, since Python ignores it.
"""

from __future__ import annotations

import os
import signal
import threading
from types import FrameType, TracebackType
from typing import Any

from ...skills.core.reasons import Reason
from .runner import Run

# name of the signal -> what is asked of the run; some systems lack one
CAUSES: dict[str, tuple[Reason, str, str]] = {
    "SIGINT": (Reason.INTERRUPTED, "", "operator"),
    "SIGTERM": (Reason.INTERRUPTED, "the program was told to end (SIGTERM)", "operator"),
    "SIGQUIT": (Reason.INTERRUPTED, "the program was told to quit (SIGQUIT)", "operator"),
    "SIGTSTP": (Reason.INTERRUPTED, "the program was told to stand still (SIGTSTP)", "operator"),
    "SIGHUP": (Reason.DISPLAY_LOST, "the terminal was closed (SIGHUP)", "display"),
}


class StopSignals:
    """Takes the signals over while it is entered.

    Args:
        suspends: whether Ctrl-Z suspends the program where there is no run.

    Attributes:
        run: to be made safe; None before there is one.
    """

    def __init__(self, *, suspends: bool = True) -> None:
        self.run: Run | None = None
        self._suspends = suspends
        self._seen: set[str] = set()
        self._before: dict[int, Any] = {}

    def __enter__(self) -> StopSignals:
        """Take them over; in another thread than the main one there are none to take."""
        for name in CAUSES if threading.current_thread() is threading.main_thread() else ():
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._receive)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give them back."""
        for number, before in self._before.items():
            signal.signal(number, before)
        self._before.clear()

    def _receive(self, number: int, frame: FrameType | None) -> None:
        name = signal.Signals(number).name
        if name == "SIGTSTP" and (self._suspends if self.run is None else self.run.time_waits):
            os.kill(os.getpid(), signal.SIGSTOP)  # a simulated robot stands still with its tree
            return
        insists = name == "SIGINT" and name in self._seen
        if self.run is None or insists or (self._seen and self.run.hangs()):
            raise KeyboardInterrupt
        self._seen.add(name)
        self.run.request_stop(*CAUSES[name])

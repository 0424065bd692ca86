"""Whether the master still answers.

Robot and tree go on to hear each other without one, but nothing new can be connected, and nobody knows what else has
stopped: the robot stands still until it answers again.

| the master | what happens |
|---|---|
| does not answer for `slow` | the robot is stopped, again and again, and takes no command before there is an answer |
| does not answer for `gone` | its senses count as lost as well, for good |
| is not there | both at once, for good: one that is begun anew knows of no node |
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from ..quantity import Quantities, quantity
from ..world import WorldError
from .clock import SLOW
from .ros import ask_master


@dataclass(frozen=True)
class MasterTimes(Quantities):
    """How long is waited for a master, by the wall clock."""

    look: float = quantity(0.05, "s", "between two questions", "choice: each costs 2 ms of processor time at both ends")
    slow: float = quantity(
        0.3,
        "s",
        "without an answer after which the robot is stopped",
        "choice: as long as the watchdog waits for a joint state, which leaves 0.15 s of half a second to ask and to "
        "brake in; measured: the slowest of 2600 answers took 0.11 s at a load of 6 to 9 on two cores, that of 700 "
        "at 15 took 0.49 s",
    )
    gone: float = quantity(
        2.0, "s", "without an answer after which it is given up", "choice: four times the slowest answer"
    )


TIMES = MasterTimes()
UNHURRIED = MasterTimes(slow=SLOW, gone=SLOW)  # where time passes as the tree waits, a slow answer keeps nothing moving


class MasterWatch:
    """Asks the master from a thread of its own.

    Args:
        stop: of the robot; called from that thread.
        times: how long it waits.
        ask: raises WorldError where no answer comes within that time.
        now: the wall clock [s].

    Attributes:
        silent: why the robot may not be moved now; empty where it may.
        lost: why nothing counts any more that the robot measures; empty where it does.
    """

    def __init__(
        self,
        stop: Callable[[], None],
        times: MasterTimes = TIMES,
        *,
        ask: Callable[[float], object] = lambda patience: ask_master("getPid", patience=patience),
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self.silent = self.lost = ""
        self._stop, self._times, self._ask, self._now = stop, times, ask, now
        self._answered = now()
        self._ended = threading.Event()

    def begin(self) -> None:
        """Begin to ask; it has answered so far."""
        self._answered = self._now()
        threading.Thread(target=self._watch, name="master", daemon=True).start()

    def end(self) -> None:
        """Ask no more."""
        self._ended.set()

    def look(self) -> None:
        """Ask once."""
        try:
            self._ask(self._times.slow)
        except WorldError as error:
            self.silent = str(error)
            late = isinstance(error.__cause__, TimeoutError)
            if not self.lost and not (late and self._now() - self._answered < self._times.gone):
                self.lost = str(error)
            with contextlib.suppress(Exception):  # the next look tries again
                self._stop()
        else:
            self._answered, self.silent = self._now(), self.lost

    def _watch(self) -> None:
        while not self._ended.wait(self._times.look):
            self.look()

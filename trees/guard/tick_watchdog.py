"""Stops the robot from a thread of its own when the tree no longer ticks: a leaf that blocks must not leave it moving.

It acts on the wall clock, so it is only for worlds whose time passes by itself; a simulated robot waits with its tree.

| what is missing | what it does |
|---|---|
| a tick or a command, for `late_tick` | `world.stop()`, again and again until ticks come |
| a sample with a new time, for `late_tick` | the same; the guard then ends the run |
| the interpreter (a library that holds it), the process | nothing: that takes one outside, as the remote world has |

A robot that stands still is stopped as well, which it does not notice: planning may take seconds.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType

from ...skills.core.reasons import Failure, Reason
from .limits import DEFAULT, Limits

PERIOD = 0.005  # [s] between two looks
AGAIN = 0.1  # [s] between two stops: one may be lost


class TickWatchdog:
    """Watches while it is entered.

    Args:
        stop: of the world itself; called from the watchdog's thread.
        limits: `late_tick` counts.
        now: the wall clock [s].

    Attributes:
        error: what `stop` raised last, if it did; it is called again nevertheless.
    """

    def __init__(
        self, stop: Callable[[], None], limits: Limits = DEFAULT, *, now: Callable[[], float] = time.monotonic
    ) -> None:
        self.error: BaseException | None = None
        self._stop = stop
        self._late = limits.late_tick
        self._now = now
        self._tick = self._sample = now()  # when the last one came
        self._stopped = -float("inf")  # when the robot was stopped last
        self._failure: Failure | None = None
        self._done = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> TickWatchdog:
        """Begin to watch."""
        self._tick = self._sample = self._now()
        self._done.clear()
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Watch no longer; a `stop` that does not come back is left alone."""
        self._done.set()
        if self._thread is not None:
            self._thread.join(1.0)

    def ticked(self) -> None:
        """The tree ticks, or sends a command."""
        self._tick = self._now()

    def sampled(self) -> None:
        """A sample with a new time has come."""
        self._sample = self._now()

    def take(self) -> Failure | None:
        """Why the robot has been stopped since this was last asked; None if it was not."""
        failure, self._failure = self._failure, None
        return failure

    def look(self) -> bool:
        """One look; True where the robot was stopped by it."""
        now = self._now()
        tick, sample = now - self._tick, now - self._sample
        if max(tick, sample) <= self._late or now - self._stopped < AGAIN:
            return False
        self._stopped = now
        if self._failure is None:
            what = "tick of the tree" if tick > self._late else "new joint state"
            self._failure = Failure(Reason.MOTION_BLOCKED, f"no {what} for {max(tick, sample):.1f} s", "watchdog")
        try:
            self._stop()
        except BaseException as error:  # whatever a driver raises, the next look stops again
            self.error = error
        return True

    def _watch(self) -> None:
        while not self._done.wait(PERIOD):
            self.look()

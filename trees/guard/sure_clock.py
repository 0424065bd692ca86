"""The world's clock, which always says a time: where the world's own gives none, the last one that it gave.

A robot is stopped, and its run is told, whatever its clock does.  So asking the time raises nothing; that it was not to
be had is kept for the guard, which ends the run, and raised by whoever waits.
"""

from __future__ import annotations

import math

from ...sim.blame import OF_FOREIGN_CODE, told
from ...sim.world import Clock, WorldError


class SureClock:
    """A clock that never fails to answer and never goes back.

    Args:
        inner: the world's own.

    Attributes:
        fault: what it did wrong first, one clause; empty while it has done nothing.
    """

    def __init__(self, inner: Clock) -> None:
        self.fault = ""
        self._inner = inner
        self._last = 0.0
        self._failed = ""  # at the last question

    def now(self) -> float:
        """The world's time, or the last one known [s]."""
        now = self  # until there is an answer
        try:
            now = self._inner.now()
            if self._last <= now < math.inf:  # nearly always
                self._last, self._failed = now, ""
                return now
            # one that went back stands still until it has caught up: whoever waits ends that (`waiting.py`)
            self._failed = "" if now < self._last else f"the clock says {now}, but a time is asked for"
        except OF_FOREIGN_CODE as error:
            answered = now is not self  # with something that is no number
            said = f"says {now!r}, but a time is asked for" if answered else f"does not say the time: {told(error)}"
            self._failed = f"the clock {said}"
        self.fault = self.fault or self._failed
        return self._last

    def wait_until(self, time: float) -> None:
        """Wait by the world's own clock; raises WorldError where it does not say the time."""
        if self._failed:
            raise WorldError(self._failed)
        self._inner.wait_until(time)

"""Pause, step and stop: pressed in the browser, obeyed by the run between two ticks."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

NAP = 0.05  # [s] wall time between two looks at whether the pause is over


class Controls:
    """What a person who watches has asked for.  The buttons are pressed in other threads than the run's.

    Attributes:
        paused: whether the world is held still.
        live: whether simulated time is kept from running ahead of the wall clock.
    """

    def __init__(self) -> None:
        self.paused = False
        self.live = False
        self._steps = 0
        self._lock = threading.Lock()
        self._offset: float | None = None

    def pause(self) -> None:
        """Hold the world still from the next tick on."""
        with self._lock:
            self.paused, self._steps = True, 0

    def go_on(self) -> None:
        """Let it run."""
        with self._lock:
            self.paused, self._offset = False, None

    def step(self) -> None:
        """Let one tick pass and hold still again."""
        with self._lock:
            self.paused, self._steps = True, self._steps + 1

    def wait(self, now: float, ended: Callable[[], bool], meanwhile: Callable[[], None]) -> None:
        """Return when the next tick may begin.

        Args:
            now: world clock [s].
            ended: whether the run has been told to stop, which ends every pause.
            meanwhile: called again and again while waiting.
        """
        while not ended() and not self._may_tick(now):
            meanwhile()
            time.sleep(NAP)  # of the wall clock: the simulation's stands still

    def _may_tick(self, now: float) -> bool:
        with self._lock:
            if self.paused:
                self._offset = None
                if self._steps:
                    self._steps -= 1
                    return True
                return False
            if not self.live:
                self._offset = None
                return True
            ahead = now - time.monotonic()
            self._offset = ahead if self._offset is None else min(self._offset, ahead)
            return ahead <= self._offset + NAP

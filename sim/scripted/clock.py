"""Time of a simulation: it passes only when somebody waits for it."""

from __future__ import annotations

from collections.abc import Callable


class SteppedClock:
    """The clock of a world that advances itself.

    Args:
        advance: brings the world, and `time` with it, to a time [s].

    Attributes:
        time: seconds since the world started.
    """

    def __init__(self, advance: Callable[[float], None]) -> None:
        self.time = 0.0
        self._advance = advance

    def now(self) -> float:
        """Seconds since the world started."""
        return self.time

    def wait_until(self, time: float) -> None:
        """Let the world advance to `time` [s]."""
        self._advance(time)

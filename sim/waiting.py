"""Waits for the world's time without trusting it: a clock may be slow, late, or stand still."""

from __future__ import annotations

import time
from collections.abc import Callable

from .world import Clock, WorldError

TRIES = 30  # waits in a row without any progress of the clock, after which it is dead
PATIENCE = 2.0  # [s] of wall time without any progress, after which it is dead
ROUNDING = 1e-6  # [s] of a clock that is a sum of steps


def wait(clock: Clock, until: float, *, wall: Callable[[], float] = time.perf_counter) -> None:
    """Return when the clock says `until` [s].

    Args:
        clock: of the world; each of its waits may come back early.
        until: world clock [s].
        wall: the wall clock [s].

    Raises:
        WorldError: the clock stands still.
    """
    last, since, tries = clock.now(), wall(), 0
    while last < until - ROUNDING:
        clock.wait_until(until)
        now = clock.now()
        if now > last:
            last, since, tries = now, wall(), 0
            continue
        tries += 1
        if tries >= TRIES or wall() - since > PATIENCE:
            raise WorldError("the world's clock stands still")

"""Ticks a tree on time: each tick under a limit of wall time, and the wait for the next one."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from py_trees.behaviour import Behaviour

from ...sim.stopwatch import Stopwatch, timed
from ...sim.waiting import wait
from ...sim.world import Clock
from ...skills.core.context import Context
from ...skills.core.reasons import Reason
from ..guard.guard import GuardedWorld
from ..guard.limits import Limits
from ..guard.tick_watchdog import TickWatchdog
from .progress import Announcer
from .time_limit import TimeLimit, TookTooLongError
from .trace import Trace

HANG = 20.0  # [s] wall time without a new tick: longer than any plan takes


class Ticker:
    """Tells trace and progress of each tick, and the watchdog that there are ticks.

    Args:
        context: shared by the skills.
        guard: around the world.
        clock: of the world.
        limits: those of a tick and of a wait count.
        period: from one tick to the next [s].
        stepped: time passes only while somebody waits, so that a wait may take as long as it likes.
        watchdog: of a world whose time passes by itself.
        trace: gets every change.
        announcer: the same.
        stopwatch: counts for `tree` and `world`, and for `held` what is `aside`.
        request_stop: asks for the safe stop: reason, detail, source.
        last_resort: called before the program ends because a tick cannot be interrupted.

    Attributes:
        period: from one tick to the next [s].
        limit: of wall time, for code of the task; to be entered while the tree is ticked.
    """

    def __init__(
        self,
        context: Context,
        guard: GuardedWorld,
        clock: Clock,
        limits: Limits,
        *,
        period: float,
        stepped: bool,
        watchdog: TickWatchdog | None,
        trace: Trace,
        announcer: Announcer,
        stopwatch: Stopwatch,
        request_stop: Callable[[Reason, str, str], None],
        last_resort: Callable[[], object],
    ) -> None:
        self.period = period
        self.limit = TimeLimit(limits.tick, last_resort)
        self.stopwatch = stopwatch
        self._context, self._guard, self._clock = context, guard, clock
        self._wait_limit = None if stepped else limits.wait
        self._watchdog = watchdog
        self._trace, self._announcer = trace, announcer
        self._request_stop = request_stop
        self._ticked = float("-inf")
        self._began = time.perf_counter()  # the last tick, by the wall clock

    @timed("tree")
    def tick(self, node: Behaviour) -> None:
        """Tick once, after what is stopping has been carried further."""
        self.begin()
        self.limit.start()
        self.advance_lease()
        self.limit.start()
        for visited in node.tick():
            self._trace.visit(visited)
            self._announcer.visit(visited)
        self.limit.pause()
        self.sweep()

    def begin(self) -> None:
        """A tick begins, or what stands for one."""
        self.beat()
        self._began = time.perf_counter()
        self._ticked = self._context.now()

    def sweep(self) -> None:
        """Tell of what was stopped without being visited."""
        self._trace.sweep()
        self._announcer.sweep()

    def beat(self) -> None:
        """A sign of life to the watchdog; a motion that it has stopped is no longer under way: its skill is told."""
        if self._watchdog is None:
            return
        self._watchdog.ticked()
        stopped = self._watchdog.take()
        if stopped is not None and self._guard.was_stopped(stopped, self._ticked):
            self._trace.add("stopped", by=stopped.node, detail=stopped.detail)
        if self._watchdog.error is not None:
            error, self._watchdog.error = self._watchdog.error, None
            self._context.report(error)

    def advance_lease(self) -> None:
        """Carry what is stopping further; a skill whose `cancel` does not come back is not asked again."""
        try:
            self._context.lease.advance()
        except TookTooLongError as error:
            self._context.report(error)
            self._context.lease.clear()
            self._guard.stop()
            self._request_stop(Reason.TIMEOUT, str(error), error.node or "runner")

    @timed("world")
    def pass_time(self) -> None:
        """Wait for the next tick; a tick that took longer than its period is followed by the next at once."""
        self.limit.start(self._wait_limit)
        try:
            wait(self._clock, self._ticked + self.period)
        finally:
            self.limit.pause()

    def hangs(self) -> bool:
        """Whether the last tick began so long ago that it will hardly end by itself."""
        return time.perf_counter() - self._began > HANG

    @contextmanager
    def aside(self) -> Iterator[None]:
        """A while within a tick that is no work of a node's, such as a breakpoint's: neither too long, nor a hang."""
        self.limit.pause()
        self._began = float("inf")
        try:
            with self.stopwatch.of("held"):
                yield
        finally:
            self._began = time.perf_counter()
            self.limit.start()

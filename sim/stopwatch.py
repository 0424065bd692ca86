"""Where the time of a run went: wall and processor time by part."""

from __future__ import annotations

import functools
import time
from collections import defaultdict
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, TypeVar

Method = TypeVar("Method", bound=Callable[..., Any])


class Stopwatch:
    """Keeps account by part; what a part does inside another counts for the inner one alone.

    Attributes:
        wall: part -> wall time [s].
        processor: part -> processor time of the thread that counts [s]; not of others that draw or record meanwhile.
    """

    def __init__(self) -> None:
        self.wall: dict[str, float] = defaultdict(float)
        self.processor: dict[str, float] = defaultdict(float)
        self._part: str | None = None
        self._since = (0.0, 0.0)

    def of(self, part: str) -> AbstractContextManager[None]:
        """Count for `part` what is done meanwhile."""
        return _Counting(self._switch, part)

    def _switch(self, part: str | None) -> str | None:
        before, (wall, processor) = self._part, self._since
        self._part, self._since = part, (time.perf_counter(), time.thread_time())
        if before is not None:
            self.wall[before] += self._since[0] - wall
            self.processor[before] += self._since[1] - processor
        return before


class _Counting:
    """Switches to a part and back: physics does so at every step, and a generator would take twice as long.

    May be entered again, but not within itself.
    """

    __slots__ = ("_before", "_part", "_switch")

    def __init__(self, switch: Callable[[str | None], str | None], part: str | None) -> None:
        self._switch, self._part = switch, part
        self._before: str | None = None

    def __enter__(self) -> None:
        self._before = self._switch(self._part)

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self._switch(self._before)


def timed(part: str) -> Callable[[Method], Method]:
    """Counts a method for `part` on the stopwatch of its object, the attribute `stopwatch`."""

    def wrap(method: Method) -> Method:
        @functools.wraps(method)
        def counted(self: Any, *args: Any, **kwargs: Any) -> Any:
            with self.stopwatch.of(part):
                return method(self, *args, **kwargs)

        return counted  # type: ignore[return-value]

    return wrap

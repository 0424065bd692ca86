"""Work for a record that is done beside the run, one piece after the other, on what the run leaves of the processor."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable
from contextlib import suppress

NICENESS = 3  # of the thread, where the system has such a thing: physics first, but the run may have to wait for it
WAITING_MAX = 2  # pieces of work that may wait


class Background:
    """A thread that works through what it is given, in order.

    The first error ends the work; whoever gives the next piece, or closes, is told of it.
    """

    def __init__(self) -> None:
        self._waiting: queue.Queue[Callable[[], None] | None] = queue.Queue(WAITING_MAX)
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._work, name="caretree video", daemon=True)
        self._thread.start()

    def give(self, work: Callable[[], None], *, wait: bool) -> bool:
        """Have `work` done.

        Args:
            work: called in the thread.
            wait: until there is room for it; else it is turned down when too much waits already.

        Returns:
            Whether it will be done.

        Raises:
            Exception: what an earlier piece of work raised; once.
        """
        self._tell()
        try:
            self._waiting.put(work, block=wait)
        except queue.Full:
            return False
        return True

    def close(self) -> None:
        """Wait until all that was given is done.  May be called twice.

        Raises:
            Exception: what a piece of work raised, if nobody was told yet.
        """
        if self._thread.is_alive():
            self._waiting.put(None)
            self._thread.join()
        self._tell()

    def _tell(self) -> None:
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _work(self) -> None:
        with suppress(AttributeError, OSError):  # not every system knows it, nor allows it
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)
        failed = False
        while (work := self._waiting.get()) is not None:
            if failed:
                continue
            try:
                work()
            except BaseException as error:
                self._error, failed = error, True

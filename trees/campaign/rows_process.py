"""Rows of the fault campaign in processes of their own: for worlds that cannot be forked, and for workers elsewhere.

A process is told on its standard input what to try, as JSON, and answers with one line a row.  What ends it loses what
it has not answered yet.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator, Mapping
from multiprocessing.connection import wait
from typing import Any

from ...sim.command_line import INTERRUPTED
from ...sim.errors import CaretreeError
from ...skills.core.reasons import Reason
from ..run.stop_signals import StopSignals
from .child import ENDING, watch
from .fault_row import FaultKey, Row, not_reached
from .fresh_rows import Missed
from .rows_here import rows_here
from .run_maker import RunRecipe
from .trial import ONE_THREAD
from .ways import Way

COMMAND = (sys.executable, "-m", __name__)


class RowsProcess:
    """A process that tries some rows.

    Args:
        recipe: of their runs.
        ways: the rows, and how their places are reached.
        forks: whether the rows may share what they have in common.
    """

    def __init__(self, recipe: RunRecipe, ways: Mapping[FaultKey, Way], *, forks: bool) -> None:
        asked = {"recipe": recipe.as_dict(), "forks": forks, "rows": [_as_list(key, way) for key, way in ways.items()]}
        self._process = subprocess.Popen(
            COMMAND,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | ONE_THREAD,
            start_new_session=True,  # the terminal's Ctrl-C reaches only us
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.output = self._process.stdout
        with contextlib.suppress(BrokenPipeError), self._process.stdin as file:
            file.write(json.dumps(asked).encode())

    def rows(self) -> Iterator[Row]:
        """Rows as they end; those are missing that it was killed before.

        Raises:
            CaretreeError: it refuses its input.
            KeyboardInterrupt: the operator ended a run there.
        """
        for line in self.output:
            with contextlib.suppress(ValueError, TypeError):  # it was killed within a line
                told = json.loads(line)
                if "error" in told:
                    raise CaretreeError(told["error"])
                yield Row(**told)
        if self._process.wait() == INTERRUPTED:
            raise KeyboardInterrupt

    def end(self) -> None:
        """End it, in the safe stop if it is at work.  May be called twice."""
        self._process.terminate()
        try:
            self._process.wait(ENDING)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self.output.close()


def rows_in_processes(recipe: RunRecipe, ways: Mapping[FaultKey, Way], jobs: int) -> Iterator[Row]:
    """One process for each row, `jobs` of them at the same time: rows as they end.

    Raises:
        CaretreeError: one refuses its input.
        KeyboardInterrupt: the operator ended a run.
    """
    missed, waiting = Missed(), iter(ways.items())
    running: dict[Any, RowsProcess] = {}
    try:
        while True:
            for key, way in waiting:
                if missed.knows(key):
                    yield not_reached(key)
                    continue
                process = RowsProcess(recipe, {key: way}, forks=False)
                running[process.output] = process
                if len(running) >= jobs:
                    break
            if not running:
                return
            for output in wait(list(running)):
                process = running[output]
                yield from map(missed.note, process.rows())
                process.end()
                del running[output]
    finally:
        for process in running.values():
            process.end()


def _as_list(key: FaultKey, way: Way) -> list[Any]:
    fails = {name: reason.name for name, reason in way.fails.items()}
    return [list(key), way.stop_at, fails, list(way.goal)]


def _ways(rows: Iterable[list[Any]]) -> dict[FaultKey, Way]:
    found: dict[FaultKey, Way] = {}
    for (node, phase, fault), stop_at, fails, (name, at) in rows:
        reasons = {skill: Reason[reason] for skill, reason in fails.items()}
        found[node, phase, fault] = Way(stop_at=stop_at, fails=reasons, goal=(name, at))
    return found


def live() -> int:
    """The life of such a process; its exit status."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what the task prints is no answer
    asked = json.load(sys.stdin)
    if not asked["forks"]:
        threading.Thread(target=watch, args=(os.getppid(),), daemon=True).start()
    try:
        with StopSignals():
            maker = RunRecipe(
                **asked["recipe"] | {"world_arguments": tuple(asked["recipe"]["world_arguments"])}
            ).maker()
            for row in rows_here(maker, _ways(asked["rows"]), forks=asked["forks"]):
                print(json.dumps(row.as_dict()), file=answers, flush=True)
    except KeyboardInterrupt:
        return INTERRUPTED
    except CaretreeError as error:
        print(json.dumps({"error": str(error)}), file=answers, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(live())

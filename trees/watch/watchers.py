"""Whoever watches a run while it goes on: a browser (`--view`), Groot2 (`--groot`), both or nobody."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...sim.errors import CaretreeError
from ...sim.extras import need
from ...sim.fence import fenced, said
from ...sim.world import World
from ..report.looks import Witness
from ..run.progress import Progress
from ..run.runner import Run

if TYPE_CHECKING:
    from ..groot.publisher import Publisher
    from .live import LiveView


class Watchers:
    """Those whom the command line asked for; what they need is imported only then.

    Args:
        options: of `caretree run`.

    Raises:
        CaretreeError: one of them cannot be served, or a port is given for none.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        self._view: LiveView | None = None
        self._groot: Publisher | None = None
        if options.port is not None and not options.view:
            raise CaretreeError("--port is the port of the view: give --view too")
        if options.groot is not None:
            from ..groot.publisher import Publisher

            self._groot = Publisher(options.groot)
            print(f"Groot2 finds the tree at {self._groot.address}", flush=True)
        if options.view:
            need("viser", "the view")
            from .live import LiveView

            try:
                self._view = LiveView(f"{options.task}, seed {options.seed}", options.port)
            except CaretreeError:
                self.close()
                raise
            print(f"live view: {self._view.url}", flush=True)

    @property
    def before_tick(self) -> Callable[[], None] | None:
        """To be called before each tick; None if nobody asks for it."""
        return self._view.before_tick if self._view else None

    def follow(self, run: Run, world: World, witness: Witness) -> None:
        """Show `run` on `world`, unguarded, from now on, and what its cameras see.

        Raises:
            CaretreeError: it cannot be shown.
        """
        if self._groot is not None:
            self._groot.follow(run)
        if self._view is not None:
            self._view.follow(run, world, witness)

    def event(self, event: Mapping[str, Any]) -> None:
        """Hear of one event of the trace."""
        if self._groot is not None:
            self._groot.event(event)

    def progress(self, progress: Progress) -> None:
        """Hear of a stage or skill that begins or ends."""
        if self._view is not None:
            self._view.progress(progress)

    def finish(self, sentence: str, directory: Path) -> None:
        """Show the end of a run that is recorded in `directory`."""
        if self._view is not None:
            fenced(self._view.finish, lambda error: print(f"the view failed: {said(error)}"))(sentence)
            print(f"look at it again: caretree view {directory}")

    def close(self) -> None:
        """End what is served."""
        for each in (self._view, self._groot):
            if each is not None:
                each.close()

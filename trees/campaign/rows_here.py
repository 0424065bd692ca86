"""Rows of the fault campaign in this process: as branches of one run where that is possible, else each in its own."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator, Mapping

from ...sim.abilities import SupportsForks
from ...sim.world import World
from .fault_row import FaultKey, Row
from .fresh_rows import fresh_rows
from .run_maker import RunMaker
from .ways import Way


def forks_on(world: World) -> bool:
    """Whether runs on a world can be branched: it is in memory alone, and the system and this process can fork."""
    return hasattr(os, "fork") and threading.active_count() == 1 and isinstance(world, SupportsForks)


def rows_here(maker: RunMaker, ways: Mapping[FaultKey, Way], *, forks: bool, jobs: int = 1) -> Iterator[Row]:
    """Rows as they end.

    Args:
        maker: of their runs.
        ways: the rows, and how their places are reached.
        forks: whether the rows may share what they have in common.
        jobs: forks at work at the same time.

    Raises:
        KeyboardInterrupt: the operator ended one of the runs.
    """
    if not forks:
        return fresh_rows(maker, ways)
    from .branches import branched_rows  # what it imports is not on every system

    return branched_rows(maker, ways, jobs)

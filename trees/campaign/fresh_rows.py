"""Rows of the fault campaign, each in a run of its own on a fresh world: what every world can do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from ...sim.abilities import SupportsRestart
from ...sim.faults import FaultSpec, FaultyWorld
from .ending import ended, finished, unsafe_after
from .fault_row import FaultKey, Row, not_reached
from .run_maker import RunMaker
from .ways import Place, Way


def fresh_row(maker: RunMaker, key: FaultKey, way: Way) -> Row:
    """Run one fault from the beginning to the end.

    Raises:
        KeyboardInterrupt: the operator ended the run.
    """
    node, phase, fault = key
    run = maker.run(FaultSpec(fault, node, phase))
    way.lead(run)
    world = run.world
    assert isinstance(world, FaultyWorld)
    try:
        result = finished(run)
        if not world.begun:
            if not isinstance(world.inner, SupportsRestart):
                return not_reached(key)
            # in another process no two runs are alike: this one says how it ended, and the next one may come there
            return replace(not_reached(key), reason=result.reason, unsafe=unsafe_after(run, result.outcome))
        return ended(key, result, world.begun[0][1], unsafe_after(run, result.outcome))
    finally:
        world.close()


def fresh_rows(maker: RunMaker, ways: Mapping[FaultKey, Way]) -> Iterator[Row]:
    """One row after the other; what one fault has not come to, the others are not tried at."""
    missed = Missed()
    for key, way in ways.items():
        yield missed.note(not_reached(key) if missed.knows(key) else fresh_row(maker, key, way))


class Missed:
    """Places that a run of their own did not come to: where all runs begin alike none will, whatever the fault."""

    def __init__(self) -> None:
        self._places: set[Place] = set()

    def knows(self, key: FaultKey) -> bool:
        """Whether no run comes there."""
        return bool(self._places & {(key[0], "start"), (key[0], key[1])})

    def note(self, row: Row) -> Row:
        """Take note of a row; hands it on."""
        if row.outcome == "not_reached" and not row.reason:
            self._places.add((row.node, row.phase))
        return row

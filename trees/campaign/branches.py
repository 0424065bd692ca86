"""One run that stands for many rows of the fault campaign, and branches into forks where these begin to differ.

All rows of a task begin with the same run.  Two of them go alike, to the last bit, as long as neither has felt what
sets it apart from the other:

| what sets a row apart | where its branch begins |
|---|---|
| a skill that is made to fail on the way to the place | where that skill starts |
| an operator who stops the run there | at that tick |
| a grip that slips | at the place; a hand that holds nothing lets nothing slip, so nothing begins |
| a person who moves | where somebody next asks where the person is |
| a fault of sensors or commands | at the first call that it changes; one that is over before is never felt |

So a row costs what lies beyond its branch, and two whose faults are felt at the same moment are one run.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from ...sim.abilities import SupportsForks
from ...sim.faults import DURATION, FOREVER, FaultyWorld
from ...sim.world import Command, Frame, Observation, World
from ...skills.core.context import Phase
from ...skills.core.reasons import Reason, SkillFailure
from ..run.runner import Run
from .ending import ended, finished, unsafe_after
from .fault_row import FaultKey, Row, not_reached
from .fork_tree import ForkTree
from .run_maker import RunMaker
from .ways import FAILED, Way

INTERRUPTED = "interrupted"
# How long a fault waits to be felt [s]: a person who has moved is found elsewhere whenever somebody asks.
WAITS = DURATION | {"person_moves": FOREVER}
Answer = TypeVar("Answer", bound=Hashable)


@dataclass(frozen=True)
class Event:
    """What happens at a phase of a skill, as one row has it; nothing by default."""

    fault: str | None = None
    stop: bool = False
    fails: Reason | None = None


NOTHING = Event()


class Variant:
    """One row under way.

    Args:
        key: of the row.
        way: to its place.

    Attributes:
        begun: when its fault began [s]; None before.
        pending: whether it has begun and goes on, and nobody has felt it.
    """

    def __init__(self, key: FaultKey, way: Way) -> None:
        self.key, self.way = key, way
        self.node, self.phase, self.fault = key
        self.begun: float | None = None
        self.pending = False
        self._armed, self._stopped = bool(way.fails), False

    @property
    def began(self) -> float:
        """When its fault began [s], where it has."""
        assert self.begun is not None
        return self.begun

    @property
    def places(self) -> set[tuple[str, str]]:
        """Nodes and phases at which it may still differ from others."""
        found = {(self.node, self.phase)} if self.begun is None else set()
        if self.way.stop_at is not None and not self._stopped:
            found.add((self.way.stop_at, "step"))
        return found | ({self.way.goal} | {(name, "start") for name in self.way.fails} if self._armed else set())

    def enter(self, name: str, phase: str, now: float, at_once: Collection[str]) -> Event:
        """What happens where a skill enters a phase; `at_once` are the faults that would change something there."""
        fault, fails = None, None
        if self.begun is None and (name, phase) == (self.node, self.phase):
            self.begun = now
            if self.fault in at_once:
                fault = self.fault
            else:
                self.pending = WAITS[self.fault] > 0.0
        stop = not self._stopped and self.way.stops(name, phase)
        self._stopped |= stop
        if (name, phase) == self.way.goal:
            self._armed = False
        elif self._armed:
            fails = self.way.failing(name, phase)
        return Event(fault, stop, fails)


class BranchingWorld(FaultyWorld):
    """A world with faults that says what it is asked before it answers."""

    def __init__(self, inner: World) -> None:
        super().__init__(inner, ())
        self.run: SharedRun | None = None

    def observe(self) -> Observation:
        """Proprioception."""
        self._told("observe")
        return super().observe()

    def look(self, camera: str) -> Frame:
        """A frame."""
        self._told("look", camera)
        return super().look(camera)

    def send(self, command: Command) -> Command:
        """Pass a command on."""
        self._told("send")
        return super().send(command)

    def stop(self) -> None:
        """Pass the stop on."""
        self._told("stop")
        super().stop()

    def _told(self, call: str, camera: str = "") -> None:
        if self.run is not None:
            self.run.called(call, camera)


class SharedRun:
    """A run, and the rows that it stands for in this process.

    Args:
        run: on `world`, not started.
        world: of the run.
        ways: the rows, and how their places are reached.
        tree: forks this process.
    """

    def __init__(self, run: Run, world: BranchingWorld, ways: Mapping[FaultKey, Way], tree: ForkTree) -> None:
        self._run, self._world, self._tree = run, world, tree
        inner = world.inner
        assert isinstance(inner, SupportsForks)
        self._inner = inner
        world.run = self
        self._told_of_person = inner.tell_of_person(lambda: self.called("person"))
        run.context.observers.append(self._entered)
        self._stand_for([Variant(key, way) for key, way in ways.items()])

    def finish(self) -> None:
        """Run to the end, in every branch, and report its rows."""
        try:
            result = finished(self._run)
        except KeyboardInterrupt:
            self._tree.report(json.dumps(INTERRUPTED))
            return
        self._pending = []
        reached = any(each.begun is not None for each in self._variants)
        unsafe = unsafe_after(self._run, result.outcome) if reached else ""
        for each in self._variants:
            row = not_reached(each.key) if each.begun is None else ended(each.key, result, each.begun, unsafe)
            self._tree.report(json.dumps(row.as_dict()))

    def called(self, call: str, camera: str = "") -> None:
        """Before a call of the world: rows that feel their fault in it are branches of their own from here on."""
        if not self._pending:
            return
        now, answers = self._world.clock.now(), dict[tuple[str, float] | None, list[Variant]]()
        for each in self._pending:
            each.pending = now < each.began + WAITS[each.fault]
        self._pending = [each for each in self._pending if each.pending]
        felt = {each for each in self._pending if self._world.feels(each.fault, call, camera)}
        if not felt:
            return
        for each in self._variants:
            same = (each.fault, 0.0 if WAITS[each.fault] == FOREVER else each.began) if each in felt else None
            each.pending &= each not in felt
            answers.setdefault(same, []).append(each)
        chosen = self._branch(answers, None)
        if chosen is not None:
            self._world.begin(*chosen)

    def _entered(self, name: str, phase: Phase) -> None:
        """Before a skill enters a phase."""
        if (name, phase) not in self._places:
            return
        now, answers = self._world.clock.now(), dict[Event, list[Variant]]()
        slips = not self._inner.slip_changes_nothing(self._world.slipping)
        at_once = ({"grip_slip"} if slips else set[str]()) | (set() if self._told_of_person else {"person_moves"})
        for each in self._variants:
            answers.setdefault(each.enter(name, phase, now, at_once), []).append(each)
        event = self._branch(answers, NOTHING)
        if event.fault is not None:
            self._world.begin(event.fault)
        if event.stop:
            self._run.request_stop(Reason.INTERRUPTED)
        if event.fails is not None:
            raise SkillFailure(event.fails, FAILED)

    def _branch(self, answers: dict[Answer, list[Variant]], usual: Answer) -> Answer:
        """Fork once for each answer but one, the usual one where it is given; the answer of this process."""
        mine = usual if usual in answers else next(iter(answers))
        for answer, variants in answers.items():
            if answer != mine and self._forked():
                mine = answer
                self._stand_for(variants)
                return mine
        self._stand_for(answers[mine])
        return mine

    def _forked(self) -> bool:
        with self._run.aside():
            forked = self._tree.fork()
        if forked:
            self._run.go_on_in_fork()
        return forked

    def _stand_for(self, variants: list[Variant]) -> None:
        self._variants = variants
        self._places = set[tuple[str, str]]().union(*(each.places for each in variants))
        self._pending = [each for each in variants if each.pending]


def branched_rows(maker: RunMaker, ways: Mapping[FaultKey, Way], jobs: int = 1) -> Iterator[Row]:
    """The rows of these places as they end, on a world that can be forked; one whose process was killed is missing.

    Raises:
        KeyboardInterrupt: the operator ended one of the runs.
    """
    inner, senses = maker.world()
    world = BranchingWorld(inner)
    tree = ForkTree(jobs)
    shared = SharedRun(maker.run_on(world, senses), world, ways, tree)
    try:
        for line in tree.reports(shared.finish):
            found = _read(line)
            if found == INTERRUPTED:
                raise KeyboardInterrupt
            if isinstance(found, Row):
                yield found
    finally:
        world.close()


def _read(line: str) -> Row | str | None:
    """A report; None where whoever wrote it was killed meanwhile."""
    try:
        told = json.loads(line)
        return Row(**told) if isinstance(told, dict) else told
    except (ValueError, TypeError):
        return None

"""The fault campaign: every skill, every phase, every fault, each as if in a run of its own on a fresh world.

A fault counts as survived when the task still succeeds or ends in the safe stop, and afterwards no hand moves,
no arm is held, and, unless the task succeeded, the fingers are open.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Mapping

from ...sim.abilities import SupportsFaults, SupportsRestart
from ...sim.errors import CaretreeError
from ...sim.faults import FAULTS, IN_PHYSICS, PHASES, FaultyWorld
from ...skills.core.skill import Skill
from ..nodes.decorators import FailSafe
from ..run.task import Task
from .ending import finished
from .fault_row import FaultKey, Row, not_reached
from .rows_here import forks_on, rows_here
from .run_maker import MakeWorld, RunMaker, RunRecipe
from .ways import Place, Way, triggers_of


class Campaign:
    """All faults at all nodes of one task.

    Args:
        task: to try.
        make_world: a fresh world, and senses if they are scripted, for every run.
        seed: of every run.
        faults: which ones; of all those that happen in physics are left out where the world does not play them.
        stage: run this stage alone, or a span of them; None for the whole task.
        jobs: runs at the same time; None for one here, and as many as it has cores on a cluster.
        address: of a Ray cluster to run on; None for this machine.
        recipe: by which other processes make the same runs: for a cluster, and for several at once on a world that
            cannot be forked.

    Attributes:
        nominal: outcome without any fault.
        nodes: skills in the order of the tree.
        left_out: faults that this world does not play.
        forks: whether rows share what they have in common, as branches of one run.

    Raises:
        CaretreeError: no job, or several where all runs share one robot.
    """

    def __init__(
        self,
        task: Task,
        make_world: MakeWorld,
        *,
        seed: int = 0,
        faults: tuple[str, ...] = FAULTS,
        stage: str | None = None,
        jobs: int | None = None,
        address: str | None = None,
        recipe: RunRecipe | None = None,
    ) -> None:
        if jobs is not None and jobs < 1:
            raise CaretreeError(f"jobs is {jobs}, but at least 1 is asked for")
        self._maker = RunMaker(task, make_world, seed=seed, stage=stage)
        self._jobs, self._address, self._recipe = jobs, address, recipe
        self._reached: set[Place] = set()
        run = self._maker.run()
        assert isinstance(run.world, FaultyWorld)
        if isinstance(run.world.inner, SupportsRestart) and (jobs or 1 if address is None else 2) > 1:
            run.world.close()
            raise CaretreeError(f"{type(run.world.inner).__name__} has one robot for all runs: no --jobs, no --address")
        unplayed = () if isinstance(run.world.inner, SupportsFaults) else tuple(f for f in faults if f in IN_PHYSICS)
        self.left_out = unplayed if faults == FAULTS else ()  # one that was asked for by name is refused
        self._faults = tuple(fault for fault in faults if fault not in self.left_out)
        self.nodes = [node.name for node in run.root.iterate() if isinstance(node, Skill)]
        movers = {node.name for node in run.root.iterate() if isinstance(node, Skill) and node.commands}
        self._safe = {
            leaf.name
            for node in run.root.iterate()
            if isinstance(node, FailSafe)
            for leaf in node.safe.iterate()
            if isinstance(leaf, Skill)
        }
        order: list[str] = []
        run.context.observers.append(lambda node, phase: self._reached.add((node, phase)))
        run.context.observers.append(lambda node, phase: order.append(node) if phase == "step" else None)
        self.nominal = finished(run)
        self.forks = forks_on(run.world.inner)
        run.world.close()
        moving = [node for node in order if node in movers]
        # to see the safe branch at work, the run is stopped where it is deepest in the task
        self._interrupt_at = moving[-1] if moving else None
        self._triggers = triggers_of(run.root)

    def plan(self) -> list[FaultKey]:
        """Every node, phase and fault."""
        return [(node, phase, fault) for node in self.nodes for phase in PHASES for fault in self._faults]

    def way(self, node: str, phase: str) -> Way | None:
        """How the faults of this place are reached; None where nothing leads there."""
        fails, goal = self._triggers[node], (node, "step") if phase == "cancel" else (node, phase)
        if node in self._safe:
            stop_at = self._interrupt_at
            reachable = stop_at is not None
        else:
            stop_at = node if phase == "cancel" else None
            reachable = goal in self._reached or bool(fails)
        return Way(stop_at=stop_at, fails={} if goal in self._reached else fails, goal=goal) if reachable else None

    def rows(self, keys: Iterable[FaultKey] | None = None) -> Generator[Row, None, None]:
        """Rows as they end, those of `keys` or of the whole plan; one whose process was killed is missing."""
        ways: dict[FaultKey, Way] = {}
        for key in self.plan() if keys is None else keys:
            way = self.way(key[0], key[1])
            if way is None:
                yield not_reached(key)
            else:
                ways[key] = way
        yield from self._tried(ways)

    def _tried(self, ways: Mapping[FaultKey, Way]) -> Iterator[Row]:
        if self._recipe is not None and self._address is not None:
            from .rows_on_cluster import rows_on_cluster

            return rows_on_cluster(self._address, self._jobs, self._recipe, ways, forks=self.forks)
        if self._recipe is not None and not self.forks and (self._jobs or 1) > 1:
            from .rows_process import rows_in_processes

            return rows_in_processes(self._recipe, ways, self._jobs or 1)
        return rows_here(self._maker, ways, forks=self.forks, jobs=self._jobs or 1)

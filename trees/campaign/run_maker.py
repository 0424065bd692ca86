"""Makes the runs of a fault campaign, all alike but for their faults, in this process or in another one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ...perception.senses import Senses
from ...sim.abilities import SupportsRestart
from ...sim.faults import FaultSpec, FaultyWorld
from ...sim.world import World
from ..run.runner import Run
from ..run.task import Task, load_task
from ..run.worlds import make_world, prepare_stage, read_world_arguments, senses_for, tick_rate_of

MakeWorld = Callable[[], tuple[World, Senses | None]]


class RunMaker:
    """Makes runs of one task.

    Args:
        task: of every run.
        make_world: a fresh world, and senses if they are scripted.
        seed: of every run.
        stage: run this stage alone, or a span of them; None for the whole task.
    """

    def __init__(self, task: Task, make_world: MakeWorld, *, seed: int = 0, stage: str | None = None) -> None:
        self._task, self._make_world, self._seed, self._stage = task, make_world, seed, stage

    def world(self) -> tuple[World, Senses | None]:
        """A fresh world where the run begins, and its senses."""
        world, senses = self._make_world()
        if isinstance(world, SupportsRestart):
            world.restart()
        prepare_stage(world, self._task, self._stage)
        return world, senses

    def run(self, *faults: FaultSpec) -> Run:
        """A fresh run with these faults, not started."""
        world, senses = self.world()
        return self.run_on(FaultyWorld(world, faults), senses)

    def run_on(self, world: FaultyWorld, senses: Senses | None) -> Run:
        """A run on this world, not started."""
        parameters = self._task.parameters(self._stage)
        settled = tick_rate_of(world.inner)
        return Run(self._task, world, seed=self._seed, settled_rate_hz=settled, senses=senses, params=parameters)


@dataclass(frozen=True, kw_only=True)
class RunRecipe:
    """All that another process needs to make the same runs, as plain data.

    Attributes:
        task: name of it, or path of its file.
        robot: that it is done with; None for the task's own.
        world, world_kind, world_arguments: as on the command line.
        seed: of every run.
        stage: run alone; None for the whole task.
        senses: what sees on a world that brings none, `own` or `scripted`.
    """

    task: str
    robot: str | None = None
    world: str = "scripted"
    world_kind: str = "easy"
    world_arguments: Sequence[str] = ()
    seed: int = 0
    stage: str | None = None
    senses: str = "own"

    def maker(self) -> RunMaker:
        """What makes these runs in this process.

        Raises:
            CaretreeError: a bad task, world or stage.
        """
        task = load_task(self.task, robot=self.robot)
        return RunMaker(task, self.worlds(task), seed=self.seed, stage=self.stage)

    def worlds(self, task: Task) -> MakeWorld:
        """What makes the worlds of these runs.

        Raises:
            CaretreeError: a bad world.
        """
        arguments = read_world_arguments(self.world, self.world_arguments)

        def made() -> tuple[World, Senses | None]:
            world, senses = make_world(self.world, task, seed=self.seed, kind=self.world_kind, arguments=arguments)
            return world, senses or senses_for(self.senses, task, world, self.seed)

        return made

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)

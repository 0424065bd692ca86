"""A skill alone on a scripted world, ticked as the runner does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from py_trees.common import Status

from ...sim.scripted.world import ScriptedWorld
from ...sim.world import SIDES, Command, Frame, Observation, Side, World
from ..core.context import Context, Grip, Phase
from ..core.reasons import Failure
from ..core.skill import Skill
from ..geometry.person_zone import PersonZone

PERIOD = 1.0 / 15.0  # [s] between two ticks, as the command line runs trees
STILL_JOINT, STILL_BASE = (
    0.02,
    0.01,
)  # [rad/s], [m/s and rad/s] slower stands still, as for the guard
STOPPED_WITHIN = 150  # ticks in which every motion can be stopped: 10 s


class OpenGuard:
    """Lets every command pass: what a skill does is judged by the bench, not limited.  The runner's guard limits.

    Args:
        inner: the world.
    """

    def __init__(self, inner: World) -> None:
        self.clock, self.room, self.robot = inner.clock, inner.room, inner.robot
        self._inner = inner
        self.zone = PersonZone(inner.room.bed)
        self._grip: dict[str, Grip] = dict.fromkeys(SIDES, "nothing")

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        return self._inner.observe()

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost."""
        return self._inner.look(camera)

    def send(self, command: Command, *, retreat: bool = False) -> Command:
        """Start a motion."""
        return self._inner.send(command)

    def stop(self) -> None:
        """End every motion now."""
        self._inner.stop()

    def update_person(self, points_in_map: np.ndarray, *, part: str = "person", radius: float = 0.06) -> None:
        """Remembered for skills that ask; nothing is limited near the person."""
        self.zone.update(points_in_map, part=part, radius=radius)

    def declare_grip(self, side: str, what: Grip) -> None:
        """Nothing is limited while an arm is held."""
        self._grip[side] = what

    def grip(self, side: str) -> Grip:
        """What a hand was said to hold."""
        return self._grip[side]

    def held_arms(self) -> dict[Side, str]:
        """None is known of."""
        return {}

    def take_fault(self) -> Failure | None:
        """There is never one."""
        return None

    def still(self) -> bool:
        """Whether neither arms nor base move."""
        seen = self.observe()
        moving = np.abs(seen.arm_velocities).max() >= STILL_JOINT or np.abs(seen.twist_base).max() >= STILL_BASE
        return not moving


class Bench:
    """One skill, its world and its context.

    Args:
        make: builds the skill.
        context: builds a fresh world and a context around it; the bench asks once.

    Attributes:
        world: moved by the skill.
        context: of the run.
        skill: the leaf.
        phases: `start`, `step` and `cancel` as they came.
        sent: number of commands that reached the world.
    """

    def __init__(
        self, make: Callable[[Context], Skill], context: Callable[[], tuple[World, Context]] | None = None
    ) -> None:
        self.world, self.context = (context or scripted_context)()
        self.sent = 0
        self._count_commands()
        self.phases: list[Phase] = []
        self.context.observers.append(lambda name, phase: self.phases.append(phase))
        self.skill = make(self.context)

    def tick(self) -> Status:
        """One tick, and the time until the next one."""
        self.context.lease.advance()
        self.skill.tick_once()
        self.let_pass(PERIOD)
        return self.skill.status

    def run(self, ticks: int) -> Status:
        """Tick until the skill ends, or `ticks` times."""
        status = self.tick()
        for _ in range(ticks - 1):
            if status != Status.RUNNING:
                break
            status = self.tick()
        return status

    def settle(self) -> None:
        """Tick nothing but the lease until nobody holds it, or for `STOPPED_WITHIN` ticks."""
        for _ in range(STOPPED_WITHIN):
            if self.context.lease.holder is None:
                return
            self.context.lease.advance()
            self.let_pass(PERIOD)

    def let_pass(self, seconds: float) -> None:
        """Let world time pass [s]."""
        self.world.clock.wait_until(self.world.clock.now() + seconds)

    def _count_commands(self) -> None:
        send = self.world.send

        def counted(command: Command) -> Command:
            self.sent += 1
            return send(command)

        self.world.send = counted  # type: ignore[method-assign] this world is the bench's own


def scripted_context(seed: int = 1, **options: Any) -> tuple[World, Context]:
    """A fresh scripted world and a context around it.

    Args:
        seed: of the sensor noise.
        **options: for the context, for instance `senses`.
    """
    world = ScriptedWorld(seed=seed)
    guard = OpenGuard(world)
    return world, Context(world=guard, guard=guard, seed=seed, **options)

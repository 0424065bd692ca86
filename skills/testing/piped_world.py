"""A world in a process of its own: whoever holds this one can reach the contract of `World` and nothing else.

What comes through the pipe is taken apart and put together anew (`sim/remote/values.py`), so an object can bring
nothing along that the contract does not declare.
"""

from __future__ import annotations

import importlib
import multiprocessing
from collections.abc import Mapping
from multiprocessing.connection import Connection
from typing import Any

from ...sim.abilities import HandKinematics, SupportsInitialStates
from ...sim.errors import CaretreeError
from ...sim.known_robots import robot_named
from ...sim.remote.values import ERRORS, packed, unpacked
from ...sim.scripted.clock import SteppedClock
from ...sim.world import Command, Frame, Observation, World, WorldError

CALLS = ("observe", "look", "send", "stop")
PATIENCE = 10.0  # with which a process is asked to end [s]


class PipedWorld(World):
    """The contract, spoken through a pipe to the world itself.

    Args:
        kind: class of that world, `package.module:Class`; this process need not import it.
        kinematics: the robot's own model, where the guard shall have one.
        begins: state in which the run begins, where it is not the usual one.
        **options: for the class.

    Raises:
        WorldError: that world could not be made.
    """

    def __init__(self, kind: str, *, kinematics: HandKinematics | None = None, begins: str = "", **options: Any):
        context = multiprocessing.get_context("spawn")
        self._pipe, far_end = context.Pipe()
        self._process = context.Process(target=_make_and_serve, args=(far_end, kind, begins, options), daemon=True)
        self._process.start()
        far_end.close()
        try:
            self.room = self._ask("room")
            self.robot = robot_named(self._ask("robot"))
        except CaretreeError:
            self.close()
            raise
        self.clock = _PipedClock(self)
        self.kinematics = kinematics

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        return self._ask("observe")

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost."""
        return self._ask("look", camera)

    def send(self, command: Command) -> Command:
        """Start a command."""
        return self._ask("send", command)

    def stop(self) -> None:
        """End every motion now."""
        self._ask("stop")

    def close(self) -> None:
        """End the world and its process; twice is once."""
        if not self._pipe.closed:
            self._pipe.close()
            self._process.join(PATIENCE)
            self._process.kill()

    def _ask(self, what: str, *values: Any) -> Any:
        try:
            self._pipe.send((what, packed(values)))
            error, answer = self._pipe.recv()
        except (EOFError, OSError) as lost:
            raise WorldError("the process of the world has ended") from lost
        if error:
            raise ERRORS.get(error, WorldError)(answer)
        return unpacked(answer)


class _PipedClock(SteppedClock):
    """Worlds in pipes are simulated: their time passes when somebody waits."""

    def __init__(self, world: PipedWorld) -> None:
        self._ask = world._ask  # one half of the same thing
        super().__init__(lambda time: self._ask("wait_until", time))

    def now(self) -> float:
        return self._ask("now")


def _make_and_serve(pipe: Connection, kind: str, begins: str, options: Mapping[str, Any]) -> None:
    """Be the world's process."""
    try:
        module, _, name = kind.partition(":")
        world: World = getattr(importlib.import_module(module), name)(**options)
        if begins:
            if not isinstance(world, SupportsInitialStates):
                raise WorldError(f"{name} has one beginning only")
            world.set_initial_state(begins)
    except Exception as error:
        pipe.recv()
        pipe.send((WorldError.__name__, f"no world: {type(error).__name__}: {error}"))
        return
    serve(pipe, world)


def serve(pipe: Connection, world: World) -> None:
    """Answer with a world what is asked at the other end of a pipe, until that is closed; then close the world."""
    answers = {name: getattr(world, name) for name in CALLS}
    answers |= {"now": world.clock.now, "wait_until": world.clock.wait_until, "room": lambda: world.room}
    answers["robot"] = lambda: world.robot.name
    try:
        while True:
            what, values = pipe.recv()
            try:
                answer = "", packed(answers[what](*map(unpacked, values)))
            except Exception as error:
                answer = type(error).__name__, str(error)
            pipe.send(answer)
    except (EOFError, OSError):
        world.close()

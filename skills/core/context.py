"""What a skill is given when it is built: a guarded world, senses, the board, memory and chance."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping
from typing import Any, Literal, Protocol, TypeVar

import numpy as np

from ...perception.senses import Senses
from ...sim.errors import CaretreeError
from ...sim.mechanics.robot_model import RobotModel
from ...sim.world import Clock, Command, Frame, Observation, RoomMap, Side
from ..geometry.person_zone import PersonZone
from .lease import MotionLease
from .ports import Board
from .reasons import Failure
from .settings import Settings

T = TypeVar("T")
Phase = Literal["start", "step", "cancel"]
Grip = Literal["nothing", "cloth", "arm"]


class SafeWorld(Protocol):
    """The world as a skill sees it: behind the guard, without truth."""

    clock: Clock
    room: RoomMap

    @property
    def robot(self) -> RobotModel:
        """What the robot is made of: skills plan with it."""
        ...

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        ...

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost, also when it is too old."""
        ...

    def send(self, command: Command, *, retreat: bool = False) -> Command:
        """Start a motion as far as the limits allow; `retreat` marks one that takes load off the person."""
        ...

    def stop(self) -> None:
        """End every motion now."""
        ...


class Guard(Protocol):
    """What a skill tells the guard, and asks it.

    Attributes:
        zone: where the person is, as skills have told.
    """

    zone: PersonZone

    def update_person(self, points_in_map: np.ndarray, *, part: str = "person", radius: float = 0.06) -> None:
        """Say where a part of the person is: (n, 3) points along its axis and its radius [m]."""
        ...

    def declare_grip(self, side: Side, what: Grip) -> None:
        """Say what a hand holds: it decides which load and speed limits apply."""
        ...

    def held_arms(self) -> Mapping[Side, str]:
        """By hand, the person's arm that it holds, as the zone names it."""
        ...

    def grip(self, side: Side) -> Grip:
        """What a hand was said to hold."""
        ...

    def take_fault(self) -> Failure | None:
        """The failure the guard holds against the running skill, once."""
        ...

    def still(self) -> bool:
        """Whether neither arms nor base move."""
        ...


class Memory:
    """Objects shared by the skills of one run (trackers, robot models), one for each type and name."""

    def __init__(self) -> None:
        self._objects: dict[tuple[type, str], Any] = {}

    def of(self, kind: type[T], make: Callable[[], T] | None = None, *, name: str = "") -> T:
        """The object of type `kind` called `name`, made on first use.

        Raises:
            CaretreeError: there is none and `make` was not given.
        """
        key = (kind, name)
        if key not in self._objects:
            if make is None:
                raise CaretreeError(f"memory holds no {kind.__name__} {name!r}")
            self._objects[key] = make()
        return self._objects[key]

    def clear(self) -> None:
        """Forget everything."""
        self._objects.clear()


class Context:
    """Everything one run shares.

    Args:
        world: behind the guard.
        guard: of that world.
        senses: to be used instead of those that the task offers.
        seed: of the run's chance; the scene is drawn from it too, so skills see only what it makes of chance.
        settings: numbers that the run sets otherwise than its tree does.
        hold: a velocity that is sent holds at least so long [s]: until the next tick, where these are rare.

    Attributes:
        board: values of ports by key.
        memory: shared objects.
        rng: the run's only source of chance.
        lease: of motion.
        observers: called with (skill name, phase) just before a skill starts, steps again or begins to cancel.
        errors: tracebacks of programming errors met so far.
    """

    def __init__(
        self,
        *,
        world: SafeWorld,
        guard: Guard,
        senses: Senses | None = None,
        seed: int = 0,
        settings: Settings | None = None,
        hold: float = 0.0,
    ) -> None:
        self.world = world
        self.guard = guard
        self._senses = senses
        self.settings = settings or Settings()
        self.hold = hold
        self.board = Board()
        self.memory = Memory()
        self.rng = _chance(seed)
        self.lease = MotionLease(self.now)
        self.observers: list[Callable[[str, Phase], None]] = []
        self.errors: list[str] = []

    def now(self) -> float:
        """World clock [s]."""
        return self.world.clock.now()

    @property
    def senses(self) -> Senses:
        """What is estimated from images.

        Raises:
            CaretreeError: this run has none.
        """
        if self._senses is None:
            raise CaretreeError("this run has no senses: the task has no senses(context) that returns some")
        return self._senses

    @property
    def has_senses(self) -> bool:
        """Whether this run has senses, given or offered."""
        return self._senses is not None

    def offer_senses(self, senses: Senses) -> None:
        """Set the senses of a task or an example; those that the run was given, or was offered first, win."""
        if self._senses is None:
            self._senses = senses

    def wrap_senses(self, wrap: Callable[[Senses], Senses]) -> None:
        """Put something in front of the senses, such as those who look on, or another eye."""
        if self._senses is not None:
            self._senses = wrap(self._senses)

    def notify(self, name: str, phase: Phase) -> None:
        """Tell the observers which phase a skill enters."""
        for observer in self.observers:
            observer(name, phase)

    def report(self, error: BaseException) -> None:
        """Keep the traceback of a programming error for the run's log."""
        self.errors.append("".join(traceback.format_exception(error)))


def _chance(seed: int) -> np.random.Generator:
    """The numbers of `np.random.default_rng(seed)`, from a generator that does not name the seed it began with."""
    bits = np.random.PCG64(0)
    bits.state = np.random.PCG64(seed).state
    return np.random.Generator(bits)

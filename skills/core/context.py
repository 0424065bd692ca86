"""What a skill is given when it is built: a guarded world, estimators, the board, memory and chance."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any, Literal, Protocol, TypeVar

import numpy as np

from ...perception.estimates import Estimate
from ...sim.errors import CaretreeError
from ...sim.world import Clock, Command, Frame, Observation, RoomMap, Side
from .lease import MotionLease
from .ports import Board
from .reasons import Failure
from .settings import Settings

T = TypeVar("T")
Phase = Literal["start", "step", "cancel"]
Grip = Literal["nothing", "cloth", "arm"]
Estimator = Callable[..., Estimate]


class SafeWorld(Protocol):
    """The world as a skill sees it: behind the guard, without truth."""

    clock: Clock
    room: RoomMap

    def observe(self) -> Observation:
        """Latest proprioception; raises SensorLost."""
        ...

    def look(self, camera: str) -> Frame:
        """Latest frame; raises SensorLost, or SkillFailure when it is stale."""
        ...

    def send(self, command: Command, *, retreat: bool = False) -> Command:
        """Start a motion as far as the limits allow; `retreat` marks one that takes load off the person."""
        ...

    def stop(self) -> None:
        """End every motion now."""
        ...


class Guard(Protocol):
    """What a skill tells the guard, and asks it."""

    def update_person(self, points_in_map: np.ndarray, *, part: str = "person", radius: float = 0.06) -> None:
        """Say where a part of the person is: (n, 3) points along its axis and its radius [m]."""
        ...

    def declare_grip(self, side: Side, what: Grip) -> None:
        """Say what a hand holds: it decides which load and speed limits apply."""
        ...

    def take_fault(self) -> Failure | None:
        """The failure the guard holds against the running skill, once."""
        ...

    def still(self) -> bool:
        """Whether neither arms nor base move."""
        ...


class Perception:
    """Named estimators: `name -> function(frame, **details) -> Estimate`, raising PerceptionFailure."""

    def __init__(self, estimators: dict[str, Estimator] | None = None) -> None:
        self._estimators = dict(estimators or {})

    def offer(self, name: str, estimator: Estimator) -> None:
        """Add an estimator unless the name is taken: a task offers its own, a test or a user has set theirs before."""
        self._estimators.setdefault(name, estimator)

    def estimate(self, name: str, frame: Frame, **details: Any) -> Estimate:
        """Ask the estimator `name`.

        Raises:
            CaretreeError: there is none of that name.
            PerceptionFailure: the image does not hold the answer.
        """
        if name not in self._estimators:
            known = ", ".join(sorted(self._estimators)) or "none"
            raise CaretreeError(f"no estimator is called {name!r}; there are {known}")
        return self._estimators[name](frame, **details)


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
        perception: estimators by name.
        seed: of the run.
        settings: numbers that the run sets otherwise than its tree does.

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
        perception: Perception | None = None,
        seed: int = 0,
        settings: Settings | None = None,
    ) -> None:
        self.world = world
        self.guard = guard
        self.perception = perception or Perception()
        self.settings = settings or Settings()
        self.board = Board()
        self.memory = Memory()
        self.seed = seed
        self.rng = np.random.default_rng(seed)
        self.lease = MotionLease(self.now)
        self.observers: list[Callable[[str, Phase], None]] = []
        self.errors: list[str] = []

    def now(self) -> float:
        """World clock [s]."""
        return self.world.clock.now()

    def perceive(self, name: str, frame: Frame, **details: Any) -> Any:
        """Ask an estimator; see `Perception.estimate`.  Typed Any because the name decides the estimate's type."""
        return self.perception.estimate(name, frame, **details)

    def notify(self, name: str, phase: Phase) -> None:
        """Tell the observers which phase a skill enters."""
        for observer in self.observers:
            observer(name, phase)

    def report(self, error: BaseException) -> None:
        """Keep the traceback of a programming error for the run's log."""
        self.errors.append("".join(traceback.format_exception(error)))

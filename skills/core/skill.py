"""The base of every skill: a py_trees leaf with typed ports and the lifecycle start, step, cancel.

Most authors write one generator:

    class Reach(Skill):
        target = Input(GraspPoint)
        reached = Output(GraspPoint)
        reasons = (Reason.UNREACHABLE,)

        def steps(self) -> Iterator[None]:
            ...                       # runs between two ticks
            yield                     # until the next tick
            raise SkillFailure(Reason.UNREACHABLE, "0.2 m short")
            self.reached = self.target

Laws, tested over every skill:

- `start` runs once per entry, then `step` once per tick; outputs are unset on entry.
- A commanding skill holds the motion lease from before `start` until its motion has stopped.
- However it ends (success, failure, exception, preemption), the lease comes back; `cancel` runs until
  it returns True when the end found the robot moving.
- Ending twice is the same as ending once.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from typing import Any, ClassVar, Literal

import py_trees
from py_trees.common import Status

from ...perception.errors import PerceptionFailure
from ...sim.blame import told
from ...sim.world import EmergencyStop, SensorLost
from ..motion.errors import MotionError, PathBlocked, Unreachable
from .context import Context
from .ports import Input, Output, bind_ports, ports_of, refuse_taken_names
from .reasons import Failure, Reason, SkillFailure, reason_of
from .scope import Scope
from .world_handle import WorldHandle

MOTION_REASONS = {Unreachable: Reason.UNREACHABLE, PathBlocked: Reason.PATH_BLOCKED}


class Skill(py_trees.behaviour.Behaviour):
    """One leaf of a tree.

    Args:
        name: unique in its tree; in a scope the scope's name comes before it.
        context: what the run shares, or a scope of it, which wires the ports that it has keys or constants for.
        **ports: a `Key` or a constant for each input, a `Key` for each output.

    Attributes:
        commands: class attribute, False for a skill that only looks and thinks; it then needs no lease.
        reasons: class attribute, what the skill fails with by its own doing; `caretree check` explores them.
        failure: why it failed last, or None.
        bindings: port name -> Key or constant.
    """

    commands: ClassVar[bool] = True
    reasons: ClassVar[tuple[Reason, ...]] = ()
    registry: ClassVar[list[type[Skill]]] = []

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if not (isinstance(cls.reasons, tuple) and all(isinstance(r, Reason) for r in cls.reasons)):
            raise TypeError(
                f"{cls.__name__}.reasons is a tuple of Reason, as (Reason.GRASP_MISSED,), not {cls.reasons!r}"
            )
        refuse_taken_names(cls)
        Skill.registry.append(cls)

    def __init__(self, name: str, context: Context | Scope, **ports: Any) -> None:
        scope = Scope.of(context)
        if not isinstance(name, str):
            raise TypeError(f"{type(self).__name__} takes its name, a text, and then the context, not {name!r}")
        super().__init__(scope.prefix + name)
        self.context = scope.context
        self.world = WorldHandle(self.context, self)
        self.bindings = bind_ports(self, scope.wired(type(self), ports))
        self.bindings |= self.context.settings.applied(type(self), self.bindings)
        self.failure: Failure | None = None
        self._phase: Literal["idle", "waiting", "active"] = "idle"
        self._generator: Generator[None, None, None] | None = None

    # -- what authors write ------------------------------------------------------------------------------

    def steps(self) -> Iterator[None]:
        """The skill as a generator: yields once per tick, returns to succeed, raises SkillFailure to fail."""
        raise NotImplementedError(f"{type(self).__name__} needs steps(), or start() and step()")

    def start(self) -> None:
        """Begin; called once per entry with the lease held."""
        steps = self.steps()
        if not isinstance(steps, Generator):
            raise TypeError(f"{type(self).__name__}.steps() must be a generator; it has no yield")
        self._generator = steps

    def step(self) -> bool:
        """Go on by one tick; True when done."""
        if self._generator is None:
            raise TypeError(f"{type(self).__name__} overrides start() but not step()")
        return next(self._generator, self) is self  # self marks the end: a generator of None never yields it

    def cancel(self) -> bool:
        """Stop moving; called once per tick until it returns True, which it may only once nothing moves."""
        self.world.stop()  # again on every tick: one stop may be lost
        return self.context.guard.still()

    # -- what authors use --------------------------------------------------------------------------------

    def note(self, message: str) -> None:
        """Say what is going on; shown beside the skill's name while it runs."""
        self.feedback_message = message

    def now(self) -> float:
        """World clock [s]."""
        return self.context.now()

    def wait(self, seconds: float) -> Iterator[None]:
        """Let `seconds` of world time pass: `yield from self.wait(0.5)`."""
        end = self.now() + seconds
        while self.now() < end:
            yield

    def until(self, done: Callable[[], object], *, timeout: float, reason: Reason = Reason.TIMEOUT) -> Iterator[None]:
        """Wait until `done()` is true: `yield from self.until(..., timeout=2.0)`.

        Raises:
            SkillFailure: with `reason` after `timeout` [s].
        """
        end = self.now() + timeout
        while not done():
            if self.now() >= end:
                raise SkillFailure(reason, f"waited {timeout:g} s")
            yield

    # -- py_trees ----------------------------------------------------------------------------------------

    def initialise(self) -> None:
        """Forget the last round: outputs, failure and generator."""
        self.failure = None
        self.feedback_message = ""
        self._generator = None
        self.reset_outputs()
        self._phase = "waiting"

    def update(self) -> Status:
        """Advance by one tick; errors become failures with a reason, so nothing escapes into the tree."""
        try:
            return Status.SUCCESS if self._advance() else Status.RUNNING
        except SkillFailure as stop:
            self.failure = Failure(stop.reason, stop.detail, self.name)
        except PerceptionFailure as stop:
            reason = Reason.__members__.get(stop.problem.name, Reason.NOTHING_SEEN)
            self.failure = Failure(reason, str(stop), self.name)
        except MotionError as stop:
            self.failure = Failure(MOTION_REASONS.get(type(stop), Reason.MOTION_BLOCKED), str(stop), self.name)
        except (SensorLost, EmergencyStop) as stop:
            self.failure = Failure(reason_of(stop), str(stop), self.name)
        except Exception as error:
            self.context.report(error)
            self.failure = Failure(Reason.INTERNAL_ERROR, told(error), self.name)
        self.feedback_message = self.failure.sentence()
        return Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """End this round once; a second call does nothing."""
        phase, self._phase = self._phase, "idle"
        if phase == "idle":
            return
        self._close()
        if phase == "waiting":
            return  # nothing was begun; an earlier round that is still stopping goes on by itself
        if new_status != Status.SUCCESS:
            self._tell_cancel()
        if not self.commands:
            return
        stopped = self._settled if new_status == Status.SUCCESS else self._cancelled
        if stopped():
            self.context.lease.release(self)
        else:
            self.context.lease.release_when(self, stopped)

    def reset_outputs(self) -> None:
        """Unset every output, so that nobody reads what an earlier round wrote."""
        for _, port in self.outputs():
            port.reset(self)

    @classmethod
    def inputs(cls) -> list[tuple[str, Input[Any]]]:
        """Input ports by name."""
        return [(name, port) for name, port in ports_of(cls) if isinstance(port, Input)]

    @classmethod
    def outputs(cls) -> list[tuple[str, Output[Any]]]:
        """Output ports by name."""
        return [(name, port) for name, port in ports_of(cls) if isinstance(port, Output)]

    def _advance(self) -> bool:
        if self._phase == "waiting":
            if self.commands and not self.context.lease.acquire(self):
                self.feedback_message = "waits for another motion to stop"
                return False
            self._phase = "active"
            self.feedback_message = ""
            self.context.guard.take_fault()  # an older fault belongs to the skill that ran then
            self.context.notify(self.name, "start")
            self.start()
        else:
            self.context.notify(self.name, "step")
            if self.commands and (fault := self.context.guard.take_fault()) is not None:
                raise SkillFailure(fault.reason, fault.detail)
        return self.step()

    def _close(self) -> None:
        try:
            if self._generator is not None:
                self._generator.close()
        except Exception as error:  # a generator's own clean-up must not stop the sweep over the tree
            self.context.report(error)

    def _tell_cancel(self) -> None:
        try:
            self.context.notify(self.name, "cancel")
        except Exception as error:  # an observer's error must not stop the sweep either
            self.context.report(error)

    def _settled(self) -> bool:
        """After success: nothing moves, or is stopped if it still does.  The author's cancel may do more than that."""
        try:
            if self.now() >= self.world.moving_until and self.context.guard.still():
                return True
            self.world.stop()
            return self.context.guard.still()
        except SensorLost:
            return False  # cannot know; the lease's patience runs out and the runner stops the world
        except Exception as error:  # a driver's, perhaps for once: asked again on the next tick
            self.context.report(error)
            return False

    def _cancelled(self) -> bool:
        try:
            return bool(self.cancel())
        except SensorLost:
            return False
        except Exception as error:
            self.context.report(error)
            return self._settled()

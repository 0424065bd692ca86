"""Runs a tree on a world: ticks it, guards it, fences its errors in, and makes the person safe at every end.

| the tree | fail-safe branch or last resort needed | outcome |
|---|---|---|
| succeeds | no | `success` |
| fails | no | `failure` |
| fails, is interrupted, raises, the senses die, or the emergency stop is pressed | yes | `safe_stop` |

Whatever happens, the last things done are: motions cancelled, `world.stop()` until nothing moves, and, where no
safe branch succeeded, the fingers opened.  Only a world that is lost keeps the safe branch from moving: errors of the
record or of the display are kept and ask for the safe stop, as an operator does.
"""

from __future__ import annotations

import difflib
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import Any, Protocol

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...perception.senses import Senses
from ...sim.blame import told
from ...sim.compiled import load
from ...sim.errors import CaretreeError, DisplayError
from ...sim.faults import FaultyWorld
from ...sim.fence import fenced, said
from ...sim.record.record import RunResult
from ...sim.scripted.clock import SteppedClock
from ...sim.stopwatch import Stopwatch
from ...sim.world import Observation, World, WorldError
from ...skills.core.context import Context
from ...skills.core.reasons import Failure, Reason
from ...skills.core.settings import Settings
from ...skills.core.skill import Skill
from ..guard.guard import GuardedWorld
from ..guard.limits import DEFAULT, Limits
from ..guard.tick_watchdog import TickWatchdog
from ..nodes.decorators import FailSafe, Stage
from ..nodes.failures import cause_of, failure_of
from .progress import Announcer, Progress
from .safe_stop import SafeStop
from .task import Task
from .ticker import Ticker
from .time_limit import TookTooLongError
from .trace import Trace

FEW_NAMES = 12  # so many are listed whole in an error
FROM_OUTSIDE = (Reason.INTERRUPTED, Reason.EMERGENCY_STOP, Reason.RECORD_LOST, Reason.DISPLAY_LOST)


class EventSink(Protocol):
    """The part of a recorder that the runner uses; `finish` stays with whoever made it."""

    def event(self, event: Mapping[str, Any]) -> None:
        """Append one event to the trace on disk."""
        ...


class Run:
    """One run of one tree; `run()` below is the usual way in.

    Args:
        task: what to do.
        world: unguarded; the run puts the guard around it.
        seed: of the run's chance.
        rate_hz: ticks per second of world time.
        settled_rate_hz: ticks per second from when all that a world with faults had in store lies behind; None for
            the same as before.
        recorder: gets every event of the trace; an error of it ends the run in the safe stop.
        on_progress: told of stages and skills as they begin and end; an error of it ends the run in the safe stop.
        senses: to be used instead of those that the task offers.
        params: for the task's `build`.
        limits: what the guard enforces.
        settings: numbers of skills that this run sets otherwise than the tree does.
        before_tick: called before each tick; may wait, and a simulated world waits too.  An error of it ends the run
            in the safe stop.
        on_sample: told of every observation of a new time; an error of it ends the run in the safe stop.
        wall: the clock by which the watchdog misses a tick of a world whose time passes by itself [s].

    Attributes:
        context: shared by the skills.
        root: the tree.
        trace: what happened.
        stopwatch: of `tree` (ticks) and `world` (the time between them).
    """

    def __init__(
        self,
        task: Task,
        world: World,
        *,
        seed: int = 0,
        rate_hz: float = 15.0,
        settled_rate_hz: float | None = None,
        recorder: EventSink | None = None,
        on_progress: Callable[[Progress], None] | None = None,
        senses: Senses | None = None,
        params: Mapping[str, Any] | None = None,
        limits: Limits = DEFAULT,
        settings: Settings | None = None,
        before_tick: Callable[[], None] | None = None,
        on_sample: Callable[[Observation], None] | None = None,
        wall: Callable[[], float] = time.monotonic,
    ) -> None:
        for name, rate in (("rate_hz", rate_hz), ("settled_rate_hz", settled_rate_hz or rate_hz)):
            if not rate > 0:
                raise CaretreeError(f"{name} is {rate}, but must be above 0")
        self.world = world
        self.limits = limits
        stepped = isinstance(world.clock, SteppedClock)
        if not stepped:
            load()
        self._watchdog = None if stepped else TickWatchdog(world.stop, limits, now=wall)
        self._on_sample = fenced(on_sample or (lambda seen: None), self.lost)
        self.guard = GuardedWorld(
            world,
            limits,
            on_command=lambda command: self.trace.command(command),
            before_command=lambda: self._ticker.beat(),
            on_sample=self._sampled,
        )
        self._settled_period = 1.0 / (settled_rate_hz or rate_hz)
        self.context = Context(
            world=self.guard,
            guard=self.guard,
            senses=senses,
            seed=seed,
            settings=settings,
            hold=1.0 / rate_hz,
        )
        self.context.lease.patience = limits.stop_patience
        self.root = task.build(self.context, **(params or {}))
        self.context.settings.check()
        for node in self.root.iterate():
            if (bind := getattr(node, "bind", None)) is not None:  # decorators and conditions
                bind(self.context)
        self.trace = Trace(self.root, self.context.now, fenced(recorder.event, self.lost) if recorder else None)
        told = fenced(on_progress or (lambda progress: None), partial(self.lost, reason=Reason.DISPLAY_LOST))
        self._before_tick = fenced(before_tick or (lambda: None), partial(self.lost, reason=Reason.DISPLAY_LOST))
        self._stop: Failure | None = None
        self.stopwatch = Stopwatch()
        self._ticker = Ticker(
            self.context,
            self.guard,
            self.guard.clock,
            limits,
            period=1.0 / rate_hz,
            stepped=stepped,
            watchdog=self._watchdog,
            trace=self.trace,
            announcer=Announcer(self.root, self.context.now, told),
            stopwatch=self.stopwatch,
            request_stop=self.request_stop,
            last_resort=lambda: self._safe_stop.last_resort(),
        )
        self._safe_stop = SafeStop(
            self.root, world, self.guard, self.context, limits, ticker=self._ticker, before_tick=self._before_tick
        )
        if isinstance(world, FaultyWorld):
            self._check_fault_nodes(world)
            self.context.observers.append(world.on_phase)

    def request_stop(self, reason: Reason = Reason.INTERRUPTED, detail: str = "", source: str = "operator") -> None:
        """Ask for the safe stop at the next tick, as an operator's button does; the first to ask is told."""
        if self._stop is None:
            self._stop = Failure(reason, detail, source)

    def lost(self, error: Exception, reason: Reason | None = None) -> None:
        """Ask for the safe stop because of an error of the display (a `DisplayError`) or of the record."""
        if reason is None:
            reason = Reason.DISPLAY_LOST if isinstance(error, DisplayError) else Reason.RECORD_LOST
        if not isinstance(error, (OSError, CaretreeError)):
            self.context.report(error)
        self.request_stop(reason, said(error), "display" if reason == Reason.DISPLAY_LOST else "recorder")

    @property
    def stopping(self) -> bool:
        """Whether the safe stop has been asked for."""
        return self._stop is not None

    @property
    def interrupted(self) -> bool:
        """Somebody pressed Ctrl-C; the run then ended in the safe stop, and who started it may want to end too."""
        return self._safe_stop.interrupted

    @property
    def time_waits(self) -> bool:
        """Whether no time passes but by this run: a robot that is simulated stands still with it."""
        return self._watchdog is None

    def hangs(self) -> bool:
        """Whether the last tick began so long ago that it will hardly end by itself."""
        return self._ticker.hangs()

    def aside(self) -> AbstractContextManager[None]:
        """A while within a tick that is no work of a node's, such as a breakpoint's: neither too long, nor a hang."""
        return self._ticker.aside()

    def go_on_in_fork(self) -> None:
        """To be called in a process that was forked during this run, and goes on with it."""
        self._ticker.limit.set_alarm()

    def _check_fault_nodes(self, world: FaultyWorld) -> None:
        skills = sorted({node.name for node in self.root.iterate() if isinstance(node, Skill)})
        for spec in world.faults:
            if spec.node not in skills:
                raise CaretreeError(f"fault {spec} names no skill of this task; {_nearest(spec.node, skills)}")

    def run(self) -> RunResult:
        """Tick to the end and make safe."""
        with self._ticker.limit, self._watchdog or nullcontext():
            return self._run()

    def _run(self) -> RunResult:
        failure: Failure | None = None
        try:
            failure = self._tick_to_end()
        except KeyboardInterrupt:
            self._safe_stop.interrupted = True
            self.request_stop()
            failure = self._stop
        except WorldError as error:
            failure = Failure(Reason.WORLD_LOST, str(error), "runner")
        except CaretreeError as error:
            failure = Failure(Reason.INTERNAL_ERROR, str(error), "runner")
        except TookTooLongError as error:
            self.context.report(error)
            failure = Failure(Reason.TIMEOUT, str(error), error.node or "runner")
        except BaseException as error:  # py_trees leaves ancestors running after an exception in a node
            self.context.report(error)
            failure = Failure(Reason.INTERNAL_ERROR, told(error), "runner")
        try:
            return self._end(failure)
        except BaseException:  # interrupted once more
            self._safe_stop.last_resort()
            raise

    def _tick_to_end(self) -> Failure | None:
        """Tick until the tree is done; the failure that stops it from outside, if one does."""
        started = self.context.now()
        while True:
            self._before_tick()
            stop = self._stop or self.guard.check()
            if stop is None and (stuck := self.context.lease.stuck()) is not None:
                stop = Failure(Reason.MOTION_BLOCKED, "it does not stop", stuck.name)
            if stop is None and self.context.now() - started > self.limits.run:
                stop = Failure(Reason.TIMEOUT, f"no run may last over {self.limits.run:g} s", "runner")
            if stop is not None:
                return stop
            if isinstance(self.world, FaultyWorld) and self.world.settled:
                self._ticker.period = self.context.hold = self._settled_period
            self._ticker.tick(self.root)
            if self.root.status != Status.RUNNING:
                return None
            self._ticker.pass_time()

    def _sampled(self, seen: Observation) -> None:
        if self._watchdog is not None:
            self._watchdog.sampled()
        self._on_sample(seen)

    def _end(self, failure: Failure | None) -> RunResult:
        """Make safe, stop, and say how it went."""
        cause = failure
        if failure is not None:
            self._safe_stop.halt(self.root)
            self._safe_stop.run_branches()
        elif self.root.status == Status.FAILURE:
            failure, cause = failure_of(self.root), cause_of(self.root)
        elif self.root.status != Status.SUCCESS:
            failure = Failure(Reason.INTERNAL_ERROR, f"the tree ended as {self.root.status.name}", self.root.name)
            cause = failure
        branches = [node for node in self.root.iterate() if isinstance(node, FailSafe)]
        owed = failure is not None and (not branches or any(node.entered for node in branches))
        made_safe = any(node.made_safe is not None for node in branches)
        # even a safe branch that succeeded may have misread fingers that were on their way
        stood = self._safe_stop.last_resort(release=failure is not None and (owed or made_safe))
        self.trace.sweep()
        if failure is None:
            outcome, reason = "success", "The task is done."
        else:
            outcome = "safe_stop" if made_safe or owed else "failure"
            reason = (cause or failure).sentence()
        if not stood:
            why = f"{self._safe_stop.refused}." if self._safe_stop.refused else Reason.MOTION_BLOCKED.value
            outcome, reason = "safe_stop", f"{_ended(reason)} The robot did not come to rest: {why}"
        self.trace.add("end", outcome=outcome, reason=failure.reason.name if failure else None)
        stages = tuple(node.result for node in _in_order(self.root) if isinstance(node, Stage))
        return RunResult(
            outcome=outcome,
            reason=reason,
            stages=stages,
            sim_time_s=self.context.now(),
            timing=self.stopwatch.wall,
            processor_timing=self.stopwatch.processor,
            trace_hash=self.trace.digest(),
            stopped_from_outside=failure is not None and failure.reason in FROM_OUTSIDE,
        )


def _ended(sentence: str) -> str:
    """With the full stop that a detail at its end does not bring."""
    return sentence if sentence.endswith((".", "!", "?", "]")) else f"{sentence}."


def _nearest(name: str, names: list[str]) -> str:
    """What could have been meant: all of a few names, else those most alike."""
    if len(names) <= FEW_NAMES:
        return f"there are {', '.join(map(repr, names))}"
    alike = difflib.get_close_matches(name, names, n=5, cutoff=0.0)
    return f"of {len(names)}, the nearest are {', '.join(map(repr, alike))}; `caretree check TASK --tree` shows all"


def _in_order(node: Behaviour) -> list[Behaviour]:
    """Nodes below `node`, parents before children, children in order."""
    return [node] + [each for child in node.children for each in _in_order(child)]


def run(
    task: Task,
    world: World,
    *,
    seed: int = 0,
    rate_hz: float = 15.0,
    recorder: EventSink | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    senses: Senses | None = None,
    params: Mapping[str, Any] | None = None,
    limits: Limits = DEFAULT,
) -> RunResult:
    """Build the task's tree on `world` and run it to its end; see `Run` for the arguments."""
    return Run(
        task,
        world,
        seed=seed,
        rate_hz=rate_hz,
        recorder=recorder,
        on_progress=on_progress,
        senses=senses,
        params=params,
        limits=limits,
    ).run()

"""Nodes that decide what happens around a subtree: retry, recovery by reason, stage, timeout, fail-safe.

All are composites whose first child is the body, so that the whole tree, recoveries included, can be seen,
checked and traced before it runs.  The runner binds them to the run's context.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping
from typing import Literal

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...sim.record.record import StageResult
from ...skills.core.context import Context
from ...skills.core.reasons import Failure, Reason
from ...skills.core.skill import Skill
from .composers import TreeError, check_children, sequence
from .condition import Condition
from .failures import failure_of


def reset_data(node: Behaviour) -> None:
    """Unset every output written below `node`, so that the next attempt starts with nothing."""
    for leaf in node.iterate():
        if isinstance(leaf, Skill):
            leaf.reset_outputs()


class Wrapper(py_trees.composites.Composite):
    """A composite with a body and a failure of its own.

    Attributes:
        failure: why it failed last, or None.
    """

    def __init__(self, name: str, *children: Behaviour) -> None:
        super().__init__(name, check_children(name, children))
        self.failure: Failure | None = None
        self.context: Context | None = None

    @property
    def body(self) -> Behaviour:
        """The wrapped subtree."""
        return self.children[0]

    def bind(self, context: Context) -> None:
        """Join a run."""
        self.context = context

    def now(self) -> float:
        """World clock [s]."""
        if self.context is None:
            raise TreeError(f"{self.name!r} is not bound to a run; only the runner ticks a tree")
        return self.context.now()

    def tick(self) -> Iterator[Behaviour]:
        """Enter if need be, let `advance` tick children, and take its status."""
        if self.status != Status.RUNNING:
            for child in self.children:
                if child.status != Status.INVALID:
                    child.stop(Status.INVALID)
            self.failure = None
            self.current_child = self.children[0]
            self.initialise()
        status = yield from self.advance()
        if status != Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def advance(self) -> Generator[Behaviour, None, Status]:
        """Tick children by `yield from self.on(child)` and return the new status."""
        raise NotImplementedError

    def on(self, child: Behaviour) -> Iterator[Behaviour]:
        """Tick one child: its own iterator, as what is visited passes through every frame between it and the root."""
        self.current_child = child
        return child.tick()

    def stop(self, new_status: Status = Status.INVALID) -> None:
        """Stop children that still run, then end."""
        for child in self.children:
            if child.status == Status.RUNNING:
                child.stop(Status.INVALID)
        super().stop(new_status)


class Retry(Wrapper):
    """Tries the body up to `attempts` times; data written by a failed attempt is unset.

    Attributes:
        attempts: at most.
        tried: attempts begun in this round.
    """

    def __init__(self, name: str, body: Behaviour, *, attempts: int) -> None:
        super().__init__(name, body)
        self.attempts = _positive(name, "attempts", attempts)
        self.tried = 0

    def initialise(self) -> None:
        """Begin the first attempt."""
        self.tried = 1

    def advance(self) -> Generator[Behaviour, None, Status]:
        """One tick of the present attempt."""
        yield from self.on(self.body)
        if self.body.status != Status.FAILURE:
            return self.body.status
        self.failure = failure_of(self.body)
        if self.tried >= self.attempts:
            return Status.FAILURE
        self.tried += 1
        self.feedback_message = f"attempt {self.tried} of {self.attempts}: {self.failure.reason.value}"
        self.body.stop(Status.INVALID)
        reset_data(self.body)
        return Status.RUNNING


class RecoverBy(Wrapper):
    """Tries the body; when it fails, runs the recovery for its reason and tries again.

    | body | recovery for the reason | recovery ends in | result |
    |---|---|---|---|
    | succeeds | | | success |
    | fails | none | | failure, the body's reason |
    | fails for the last time | any | | failure, the body's reason |
    | fails | there is one | success | body again, its data unset |
    | fails | there is one | failure | failure, the body's reason |

    Args:
        name: of the node.
        body: what to do.
        recoveries: reason -> function that builds the subtree (a node, or a class or lambda that makes one); reasons
            with the same function share one subtree.
        attempts: how often the body may be tried in all.
    """

    def __init__(
        self, name: str, body: Behaviour, recoveries: Mapping[Reason, Callable[[], Behaviour]], *, attempts: int = 2
    ) -> None:
        if not recoveries or not all(isinstance(reason, Reason) for reason in recoveries):
            raise TreeError(
                f"recoveries of {name!r} map a Reason to a function that builds a subtree, e.g. "
                "{Reason.MULTI_LAYER: build_shake}"
            )
        if ready := [make for make in recoveries.values() if not callable(make)]:
            raise TreeError(
                f"a recovery of {name!r} is the node {getattr(ready[0], 'name', ready[0])!r}, but a "
                "function that builds a subtree is asked for, e.g. lambda: Hold('wait', context)"
            )
        built = {make: make() for make in dict.fromkeys(recoveries.values())}
        subtrees = {reason: built[make] for reason, make in recoveries.items()}
        super().__init__(name, body, *built.values())
        self.recoveries = subtrees
        self.attempts = _positive(name, "attempts", attempts)
        self.tried = 0
        self._recovering: Behaviour | None = None

    def initialise(self) -> None:
        """Begin the first attempt."""
        self.tried, self._recovering = 1, None

    @property
    def recovering(self) -> Behaviour | None:
        """The recovery that runs now."""
        return self._recovering

    def advance(self) -> Generator[Behaviour, None, Status]:
        """One tick of the body or of the recovery."""
        if self._recovering is None:
            yield from self.on(self.body)
            if self.body.status != Status.FAILURE:
                return self.body.status
            self.failure = failure_of(self.body)
            recovery = self.recoveries.get(self.failure.reason)
            if recovery is None or self.tried >= self.attempts:
                return Status.FAILURE
            self._recovering = recovery
            self.feedback_message = f"recovers: {self.failure.reason.value}"
            return Status.RUNNING  # the recovery begins on the next tick, so each tick has one commander
        recovery = self._recovering
        yield from self.on(recovery)
        if recovery.status == Status.RUNNING:
            return Status.RUNNING
        if recovery.status == Status.FAILURE:
            cause, failed = self.failure, failure_of(recovery)
            if cause is not None:
                both = [cause.detail, f"the recovery failed: {failed.sentence()}"]
                self.failure = Failure(cause.reason, "; ".join(filter(None, both)), cause.node)
            return Status.FAILURE
        self._recovering = None
        self.tried += 1
        self.feedback_message = f"attempt {self.tried} of {self.attempts}"
        self.body.stop(Status.INVALID)
        reset_data(self.body)
        return Status.RUNNING


class Timeout(Wrapper):
    """Fails the body with Reason.TIMEOUT after `seconds` of the world's clock."""

    def __init__(self, name: str, body: Behaviour, *, seconds: float) -> None:
        super().__init__(name, body)
        if not isinstance(seconds, int | float) or not seconds > 0:
            raise TreeError(f"seconds of {name!r} is {seconds!r}, but must be a number above 0")
        self.seconds = seconds
        self.ends = 0.0  # [s] world clock at which time is up

    def initialise(self) -> None:
        """Start the clock."""
        self.ends = self.now() + self.seconds

    def advance(self) -> Generator[Behaviour, None, Status]:
        """One tick of the body unless time is up."""
        if self.now() >= self.ends:
            self.failure = Failure(Reason.TIMEOUT, f"allowed {self.seconds:g} s", self.name)
            self.body.stop(Status.INVALID)
            return Status.FAILURE
        yield from self.on(self.body)
        return self.body.status


class Stage(Wrapper):
    """A part of the task that the record names: checks its pre-condition, runs the body, keeps the account.

    Args:
        name: as the operator reads it.
        precondition: a leaf, or a function of the context that says whether the stage may begin; None for always.
        body: what the stage does.

    Attributes:
        result: for run.json; counts every attempt made inside.
    """

    def __init__(
        self, name: str, precondition: Behaviour | Callable[[Context], object] | None, body: Behaviour
    ) -> None:
        if isinstance(precondition, Behaviour):
            first: Behaviour | None = precondition
        else:
            first = Condition(f"{name}: pre-condition", precondition) if precondition else None
        super().__init__(name, *([body] if first is None else [body, first]))
        self.precondition = first
        self._checked = False
        self._attempts = 0
        self._status: Literal["success", "failure", "running", "not_run"] = "not_run"
        self._times: list[float | None] = [None, None]
        self._reason = ""

    def initialise(self) -> None:
        """Note the start."""
        for node in self.iterate():
            if isinstance(node, (Retry, RecoverBy)):
                node.tried = 0  # attempts of an earlier round are counted already
        self._checked = self.precondition is None
        self._attempts += 1
        self._status, self._reason = "running", ""
        self._times = [self._times[0] if self._times[0] is not None else self.now(), None]

    def advance(self) -> Generator[Behaviour, None, Status]:
        """One tick of the pre-condition, then of the body."""
        if not self._checked and self.precondition is not None:
            yield from self.on(self.precondition)
            if self.precondition.status != Status.SUCCESS:
                if self.precondition.status == Status.FAILURE:
                    self.failure = failure_of(self.precondition)
                return self.precondition.status
            self._checked = True
        yield from self.on(self.body)
        if self.body.status == Status.FAILURE:
            self.failure = failure_of(self.body)
        return self.body.status

    def terminate(self, new_status: Status) -> None:
        """Note the end; a stage cut short stays `running` in the record."""
        if self._status != "running" or self._times[1] is not None:
            return
        self._attempts += sum(max(node.tried - 1, 0) for node in self.iterate() if isinstance(node, (Retry, RecoverBy)))
        self._times[1] = self.now()
        if new_status != Status.INVALID:
            self._status = "success" if new_status == Status.SUCCESS else "failure"
            self._reason = self.failure.sentence() if self.failure and new_status == Status.FAILURE else ""

    @property
    def result(self) -> StageResult:
        """The account so far."""
        return StageResult(
            name=self.name,
            status=self._status,
            attempts=self._attempts,
            t_start=self._times[0],
            t_end=self._times[1],
            reason=self._reason,
        )


def timed_stage(
    name: str,
    *children: Behaviour,
    seconds: float,
    precondition: Behaviour | Callable[[Context], object] | None = None,
) -> Stage:
    """A stage whose children run in turn and must end within `seconds` of the world's clock."""
    return Stage(name, precondition, Timeout(f"{name} in time", sequence(f"{name}: all", *children), seconds=seconds))


class FailSafe(Wrapper):
    """Runs `safe` when the body fails (release, back off, lower the arm, stop), then fails with the body's reason.

    When the run must end from outside (an interrupt, dead senses, an error in a node), the runner stops the body
    and ticks `safe` itself.

    Attributes:
        entered: the body began and has not succeeded, so `safe` is owed if the run ends now.
        made_safe: `safe` ran in this run; None when it did not, else whether it succeeded.
    """

    def __init__(self, name: str, body: Behaviour, safe: Behaviour) -> None:
        super().__init__(name, body, safe)
        self.entered = False
        self.made_safe: bool | None = None

    @property
    def safe(self) -> Behaviour:
        """The branch that makes the person safe."""
        return self.children[1]

    def initialise(self) -> None:
        """Owe the safe branch from now on."""
        self.entered = True

    def advance(self) -> Generator[Behaviour, None, Status]:
        """One tick of the body, or of the safe branch once the body has failed."""
        if self.failure is None:
            yield from self.on(self.body)
            if self.body.status == Status.SUCCESS:
                self.entered = False
            if self.body.status != Status.FAILURE:
                return self.body.status
            self.failure = failure_of(self.body)
            self.feedback_message = self.failure.sentence()
            return Status.RUNNING
        yield from self.on(self.safe)
        if self.safe.status == Status.RUNNING:
            return Status.RUNNING
        self.made_safe = self.safe.status == Status.SUCCESS
        self.entered = not self.made_safe  # owed to an outer fail-safe or to the runner's last resort
        return Status.FAILURE


def _positive(name: str, what: str, value: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        raise TreeError(f"{what} of {name!r} is {value!r}, but a whole number from 1 is asked for")
    return value

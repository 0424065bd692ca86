"""The laws that every skill keeps however it ends, as gymnasium's `check_env` is for environments."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from py_trees.common import Status

from ...sim.world import World
from ..core.context import Context
from ..core.ports import Key
from ..core.reasons import Reason
from ..core.skill import Skill
from .bench import Bench

Fresh = Callable[[], Bench]  # the skill anew, on a world of its own
LONGEST = 3000  # ticks that any skill may take: 200 s
PREEMPTED_AFTER = (1, 2, 3, 5, 8, 13, 21, 34)  # ticks
BROKEN_AT = (1, 2, 3, 8)  # ticks
CREEP = 5e-3  # [rad] that an arm may move in the second after it was said to stand still


class LawBroken(AssertionError):  # noqa: N818 it states what is wrong, as assertions do
    """A skill does not keep a law; the message says which and how."""


def check_skill(
    make: Callable[[Context], Skill], *, context: Callable[[], tuple[World, Context]] | None = None
) -> None:
    """Try every law on a skill.

    Args:
        make: builds the skill from a context, with whatever its inputs need.
        context: builds a fresh world and a context around it; a scripted world with an empty room if not given.

    Raises:
        LawBroken: the skill does not keep one of `LAWS`.
    """
    for law in LAWS:
        law(lambda: Bench(make, context))


def ending_gives_the_lease_back(fresh: Fresh) -> None:
    """It ends by itself, with a reason of its own if it fails, and then another skill may move the robot."""
    bench = fresh()
    _run_to_end(bench)
    _settle(bench)
    if bench.skill.status == Status.FAILURE:
        failure = bench.skill.failure
        _law(failure is not None and isinstance(failure.reason, Reason), bench, "it failed without a reason")
        internal = failure is not None and failure.reason == Reason.INTERNAL_ERROR
        _law(not internal, bench, f"it raised an error: {''.join(bench.context.errors)}")
    _law(bench.phases.count("start") == 1, bench, "it was started more than once in one round")


def preemption_at_every_tick_stops_the_motion(fresh: Fresh) -> None:
    """Ended from outside at any time, it brings the robot to rest before it gives the lease back; twice is once."""
    for ticks in PREEMPTED_AFTER:
        bench = fresh()
        if bench.run(ticks) != Status.RUNNING:
            return
        bench.skill.stop(Status.INVALID)
        cancels = bench.phases.count("cancel")
        bench.skill.stop(Status.INVALID)
        _law(bench.phases.count("cancel") == cancels == 1, bench, "ending it twice is not the same as ending it once")
        _settle(bench)
        where = bench.world.observe().arm_positions
        bench.let_pass(1.0)
        moved = float(np.abs(where - bench.world.observe().arm_positions).max())
        _law(moved < CREEP, bench, f"preempted after {ticks} ticks, an arm went on by {moved:.3f} rad")


def an_error_becomes_a_reason(fresh: Fresh) -> None:
    """An exception in a step ends it as failed with `INTERNAL_ERROR`, and the lease comes back."""
    for ticks in BROKEN_AT:
        bench = fresh()
        step, count = bench.skill.step, [0]

        def broken(step: Callable[[], bool] = step, count: list[int] = count, ticks: int = ticks) -> bool:
            count[0] += 1
            if count[0] == ticks:
                raise ZeroDivisionError("planted by check_skill")
            return step()

        bench.skill.step = broken  # type: ignore[method-assign] of this one instance
        bench.run(LONGEST)
        if count[0] < ticks:
            return
        reason = bench.skill.failure.reason if bench.skill.failure else None
        _law(reason == Reason.INTERNAL_ERROR, bench, f"an error in step {ticks} ended it with {reason}")
        _law("planted" in bench.context.errors[0], bench, "the error's traceback was not kept")
        _settle(bench)


def a_second_round_starts_afresh(fresh: Fresh) -> None:
    """Entered again, it has forgotten what the first round wrote, and comes to its end."""
    bench = fresh()
    bench.tick()
    bench.skill.stop(Status.INVALID)
    bench.tick()  # may still wait for its own motion to stop
    for name, _ in type(bench.skill).outputs():
        bound = bench.skill.bindings[name]
        stale = isinstance(bound, Key) and bound.name in bench.context.board
        _law(not stale, bench, f"output {name} of the first round is still there")
    _run_to_end(bench)
    _settle(bench)


def nothing_is_commanded_without_the_lease(fresh: Fresh) -> None:
    """While another skill holds the lease it waits; ended then, it takes nothing away from the other."""
    bench = fresh()
    other = Skill("other", bench.context)
    bench.context.lease.acquire(other)
    for _ in range(5):
        bench.tick()
    commands = type(bench.skill).commands
    if commands:
        _law(bench.skill.status == Status.RUNNING, bench, "it ended although it only waited for the lease")
        _law(not bench.phases, bench, "it began without the lease")
    _law(bench.sent == 0, bench, "it commanded without the lease")
    bench.skill.stop(Status.INVALID)
    _law(bench.context.lease.holder is other, bench, "it only waited, and took the other's lease away")
    _law("cancel" not in bench.phases or not commands, bench, "it never began, and was cancelled")
    _law(not bench.context.errors, bench, "".join(bench.context.errors))


LAWS: tuple[Callable[[Fresh], None], ...] = (
    ending_gives_the_lease_back,
    preemption_at_every_tick_stops_the_motion,
    an_error_becomes_a_reason,
    a_second_round_starts_afresh,
    nothing_is_commanded_without_the_lease,
)


def _law(holds: bool, bench: Bench, sentence: str) -> None:
    if not holds:
        raise LawBroken(f"{type(bench.skill).__name__} {bench.skill.name!r}: {sentence}")


def _run_to_end(bench: Bench) -> None:
    status = bench.run(LONGEST)
    _law(status != Status.RUNNING, bench, f"it does not end within {LONGEST} ticks on the scripted world")


def _settle(bench: Bench) -> None:
    """The lease comes back, and not before all is still."""
    bench.settle()
    _law(bench.context.lease.holder is None, bench, "the lease did not come back")
    _law(not bench.context.lease.releasing(), bench, "the lease came back and is still being released")
    _law(bench.context.guard.still(), bench, "the lease came back while the robot still moved")

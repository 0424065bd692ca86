"""The laws of skills.skill, over every skill of the package."""

import importlib
import pkgutil

import caretree.skills
import caretree.trees.tasks
import numpy as np
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.core.reasons import Reason
from caretree.skills.core.skill import Skill
from caretree.trees.guard.guard import GuardedWorld
from py_trees.common import Status

PERIOD = 1 / 15
STOPPED_WITHIN = 150  # ticks
for package in (caretree.skills, caretree.trees.tasks):
    for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        importlib.import_module(info.name)
ALL = sorted(
    (kind for kind in Skill.registry if kind.__module__.startswith("caretree.")), key=lambda kind: kind.__name__
)


class Bench:
    """A skill alone on a scripted world, ticked as the runner does."""

    def __init__(self, kind):
        self.world = ScriptedWorld(seed=1)
        self.guard = GuardedWorld(self.world)
        self.context = Context(world=self.guard, guard=self.guard, seed=1)
        self.skill = kind.example(self.context)
        self.phases = []
        self.context.observers.append(lambda name, phase: self.phases.append(phase))

    def tick(self):
        self.context.lease.advance()
        self.skill.tick_once()
        self.world.clock.wait_until(self.world.clock.now() + PERIOD)
        return self.skill.status

    def settle(self):
        """Tick nothing but the lease until it is free, which must not be before all is still."""
        for _ in range(STOPPED_WITHIN):
            if self.context.lease.holder is None:
                break
            self.context.lease.advance()
            self.world.clock.wait_until(self.world.clock.now() + PERIOD)
        assert self.context.lease.holder is None, "the lease did not come back"
        assert not self.context.lease.releasing()
        assert self.guard.still(), "the lease came back while the robot still moved"


def run_to_end(bench, ticks=3000):
    for _ in range(ticks):
        if bench.tick() != Status.RUNNING:
            return
    pytest.fail(f"{bench.skill.name} does not end within {ticks} ticks on the scripted world")


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_ending_gives_the_lease_back(kind):
    bench = Bench(kind)
    run_to_end(bench)
    bench.settle()
    if bench.skill.status == Status.FAILURE:
        assert isinstance(bench.skill.failure.reason, Reason)
        assert bench.skill.failure.reason != Reason.INTERNAL_ERROR, bench.context.errors
    assert bench.phases.count("start") == 1


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_preemption_at_every_tick_stops_the_motion(kind):
    for ticks in (1, 2, 3, 5, 8, 13, 21, 34):
        bench = Bench(kind)
        if any(bench.tick() != Status.RUNNING for _ in range(ticks)):
            break
        bench.skill.stop(Status.INVALID)
        cancels = bench.phases.count("cancel")
        bench.skill.stop(Status.INVALID)
        assert bench.phases.count("cancel") == cancels == 1, "ending twice is ending once"
        bench.settle()
        where = bench.world.observe().arm_positions
        bench.world.clock.wait_until(bench.world.clock.now() + 1.0)
        assert np.abs(where - bench.world.observe().arm_positions).max() < 5e-3  # [rad]


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_an_exception_becomes_a_reason_and_gives_the_lease_back(kind):
    for ticks in (1, 2, 3, 8):
        bench = Bench(kind)
        step, count = bench.skill.step, [0]

        def broken(step=step, count=count, ticks=ticks):
            count[0] += 1
            if count[0] == ticks:
                raise ZeroDivisionError("planted")
            return step()

        bench.skill.step = broken
        while bench.tick() == Status.RUNNING:
            pass
        if count[0] < ticks:
            break
        assert bench.skill.status == Status.FAILURE
        assert bench.skill.failure.reason == Reason.INTERNAL_ERROR
        assert "planted" in bench.context.errors[0]
        bench.settle()


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_a_second_round_starts_afresh(kind):
    bench = Bench(kind)
    bench.tick()
    bench.skill.stop(Status.INVALID)
    bench.tick()  # may still wait for its own motion to stop
    for name, _ in kind.outputs():
        bound = bench.skill.bindings[name]
        assert getattr(bound, "name", None) not in bench.context.board
    run_to_end(bench)
    bench.settle()


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_nothing_is_commanded_while_another_holds_the_lease(kind):
    bench = Bench(kind)
    other = Skill("other", bench.context)
    assert bench.context.lease.acquire(other)
    for _ in range(5):
        bench.tick()
    if kind.commands:
        assert bench.skill.status == Status.RUNNING
        assert bench.phases == []
    assert bench.world.sent == []
    bench.skill.stop(Status.INVALID)
    assert bench.context.lease.holder is other, "a skill that only waited must not take the other's lease away"
    assert "cancel" not in bench.phases or not kind.commands, "what never started has nothing to cancel"
    assert not bench.context.errors

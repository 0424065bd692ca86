"""Ticks come on time, and a wait that never ends is no wait."""

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.faults import SETTLED, FaultSpec, FaultyWorld
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.control.together import together
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.limits import Limits
from caretree.trees.nodes.composers import parallel
from caretree.trees.nodes.decorators import Timeout

from ..planted import Plan, run_of
from .at_rest import guarded_task


def test_a_wait_of_a_wall_clock_that_never_ends_is_interrupted():
    class Clock:
        def __init__(self):
            self.waits = 0

        def now(self):
            return 0.0

        def wait_until(self, time):
            self.waits += 1
            while True:
                pass

    class Hangs(ScriptedWorld):
        def __init__(self):
            super().__init__()
            self.clock = Clock()

    # on a busy machine 0.05 s were over before it hung, in a callback of the garbage collector, which drops exceptions
    run = run_of(lambda context: guarded_task(context, True, ticks=100), Hangs(), limits=Limits(wait=0.5))
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.TIMEOUT.value)
    assert run.world.clock.waits < 5


def test_a_clock_that_stands_still_ends_the_run():
    class Stopped(ScriptedWorld):
        def _advance_to(self, time):
            super()._advance_to(min(time, 0.3))

    result = run_of(lambda context: guarded_task(context, True, ticks=100), Stopped()).run()
    assert result.outcome == "safe_stop"
    assert "the world's clock stands still" in result.reason
    assert result.reason.startswith(Reason.WORLD_LOST.value)


def test_a_world_whose_time_does_not_wait_is_ticked_on_time():
    """On hardware a tick takes time itself: the next is due one period after its start, or at once if it is late."""
    ticks = []

    class Slow(Plan):
        def steps(self):
            for took in (0.03, 0.2, 0.0, 0.0):
                ticks.append(self.now())
                run.world.clock.wait_until(self.now() + took)
                yield

    run = run_of(lambda context: Slow("slow", context, outcomes=[True]), rate_hz=10.0)
    assert run.run().outcome == "success"
    assert ticks == pytest.approx([0.0, 0.1, 0.3, 0.4])


def test_a_run_is_ticked_otherwise_when_its_fault_lies_behind():
    ticks = []

    class Watches(Plan):
        def steps(self):
            while self.now() < SETTLED + 2.0:
                ticks.append(self.now())
                self.world.look("head")
                yield

    world = FaultyWorld(ScriptedWorld(), [FaultSpec("occlusion", "watch", "step")])
    run = run_of(lambda context: Watches("watch", context, outcomes=[True]), world, rate_hz=10.0, settled_rate_hz=2.0)
    assert run.run().outcome == "success"
    apart, often = np.diff(ticks), np.array(ticks[:-1]) < 0.05 + SETTLED
    np.testing.assert_allclose(apart[often], 0.1)
    np.testing.assert_allclose(apart[~often], 0.5)
    assert run.context.hold == 0.5
    for rates in ({"rate_hz": 0.0}, {"settled_rate_hz": -1.0}):
        with pytest.raises(CaretreeError, match="but must be above 0"):
            run_of(lambda context: Watches("watch", context, outcomes=[True]), **rates)


class Quiet(ScriptedWorld):
    """A world that says until when it is quiet."""

    until = np.inf

    def quiet_until(self):
        return self.until


class Waits(Plan):
    """Waits for three seconds and then for a half; or looks on at each tick for as long."""

    commands = False
    looks_on = False

    def steps(self):
        self.ticked = []
        if self.looks_on:
            yield from self.until(lambda: self.ticked.append(self.now()) or self.now() >= 3.5, timeout=9.0)
            return
        for seconds in (3.0, 0.5):
            self.ticked.append(self.now())
            yield from self.wait(seconds)
        self.ticked.append(self.now())


class LooksOn(Waits):
    looks_on = True


def ticks_of(*kinds, until=np.inf, seconds=None):
    """When a tree of such leaves, side by side, was ticked, and how it ended."""
    world, times = Quiet(), []
    world.until = until

    def tree(context):
        nodes = [kind(f"waits {n}", context, outcomes=[True]) for n, kind in enumerate(kinds)]
        both = nodes[0] if len(nodes) == 1 else parallel("both", *nodes)
        return both if seconds is None else Timeout("in time", both, seconds=seconds)

    run = run_of(tree, world, rate_hz=10.0, before_tick=lambda: times.append(run.context.now()))
    return times, run.run().outcome


def test_where_the_tree_waits_in_a_quiet_world_the_next_tick_comes_when_the_wait_is_over():
    assert ticks_of(Waits) == (pytest.approx([0.0, 3.0, 3.5]), "success")


def test_of_two_waits_the_first_to_be_over_counts():
    class Twice(Waits):
        def steps(self):
            yield from together(self.wait(1.0), self.wait(0.35), self.wait(2.0))

    assert ticks_of(Twice)[0] == pytest.approx([0.0, 0.35, 1.0, 2.0])
    assert ticks_of(Waits, Twice)[0] == pytest.approx([0.0, 0.35, 1.0, 2.0, 2.1, 3.0, 3.5])


def test_time_that_is_up_ends_a_wait():
    assert ticks_of(Waits, seconds=2.05) == (pytest.approx([0.0, 2.05]), "safe_stop")


def test_a_world_that_is_not_quiet_is_ticked_on_time():
    assert ticks_of(Waits, until=1.05)[0][:4] == pytest.approx([0.0, 1.05, 1.15, 1.25])
    assert ticks_of(Waits, until=-np.inf)[0][:4] == pytest.approx([0.0, 0.1, 0.2, 0.3])


def test_a_leaf_that_looks_on_is_ticked_on_time():
    for kinds in ((LooksOn,), (LooksOn, Waits), (Waits, LooksOn)):
        assert ticks_of(*kinds)[0][:4] == pytest.approx([0.0, 0.1, 0.2, 0.3])

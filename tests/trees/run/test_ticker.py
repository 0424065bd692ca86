"""Ticks come on time, and a wait that never ends is no wait."""

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.faults import SETTLED, FaultSpec, FaultyWorld
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.limits import Limits

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

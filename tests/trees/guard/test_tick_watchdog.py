"""The robot is stopped without the tree, by a clock that the tests set."""

import threading

import numpy as np
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import HandTwist
from caretree.skills.core.reasons import Failure, Reason
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.guard.limits import DEFAULT
from caretree.trees.guard.tick_watchdog import AGAIN, PERIOD, TickWatchdog
from caretree.trees.nodes.decorators import FailSafe, Stage
from caretree.trees.run import runner
from caretree.trees.run.runner import Run

from ..planted import Plan, Release, run_of

LATE = DEFAULT.late_tick + 0.01  # [s]


class Bench:
    """A watchdog, its clock, and the stops that it gave."""

    def __init__(self, stop=None):
        self.time, self.stops = 0.0, []
        self.dog = TickWatchdog(stop or (lambda: self.stops.append(self.time)), now=lambda: self.time)

    def look_until(self, time):
        while self.time < time - 1e-9:
            self.time += PERIOD
            self.dog.look()


def test_as_long_as_ticks_and_samples_come_nothing_is_stopped():
    bench = Bench()
    for time in np.arange(0.0, 3.0, 1 / 15):
        bench.dog.ticked()
        bench.dog.sampled()
        bench.look_until(time)
    assert bench.stops == []
    assert bench.dog.take() is None


def test_without_ticks_the_robot_is_stopped_again_and_again_until_they_come():
    bench = Bench()
    bench.look_until(1.0)
    assert bench.stops[0] == pytest.approx(LATE, abs=2 * PERIOD)
    assert np.diff(bench.stops) == pytest.approx(np.full(len(bench.stops) - 1, AGAIN), abs=2 * PERIOD)
    failure, count = bench.dog.take(), len(bench.stops)
    assert failure.reason == Reason.MOTION_BLOCKED
    assert failure.sentence().endswith("[watchdog] no tick of the tree for 0.3 s")
    assert bench.dog.take() is None
    bench.dog.ticked(), bench.dog.sampled()
    bench.look_until(1.2)
    assert len(bench.stops) == count


def test_a_tree_that_ticks_over_dead_senses_is_stopped_too():
    bench = Bench()
    while bench.time < 0.5:
        bench.dog.ticked()
        bench.look_until(bench.time + 0.05)
    assert bench.stops[0] == pytest.approx(LATE, abs=2 * PERIOD)
    assert "no new joint state" in bench.dog.take().detail


def test_a_stop_that_fails_is_tried_again_and_kept():
    def stop():
        bench.stops.append(bench.time)
        raise OSError("the line is dead")

    bench = Bench(stop)
    bench.look_until(0.7)
    assert len(bench.stops) >= 3
    assert str(bench.dog.error) == "the line is dead"


def test_it_looks_from_a_thread_of_its_own_while_it_is_entered():
    stopped, threads = threading.Event(), []

    def stop():
        threads.append(threading.current_thread())
        stopped.set()

    bench = Bench(stop)
    with bench.dog:
        bench.time = LATE
        assert stopped.wait(10.0)
    assert threads[0] is not threading.current_thread()
    assert not threads[0].is_alive()


def test_a_motion_that_was_stopped_is_held_against_the_running_skill_and_rest_is_not():
    world = ScriptedWorld()
    guard = GuardedWorld(world)
    why = Failure(Reason.MOTION_BLOCKED, "no tick", "watchdog")
    assert not guard.was_stopped(why, world.clock.now())
    assert guard.take_fault() is None
    guard.send(HandTwist(side="left", twist_in_map=0.05 * np.eye(6)[2], duration=0.5))
    assert guard.was_stopped(why, world.clock.now())
    assert guard.take_fault() is why


class OnItsOwn(ScriptedWorld):
    """Its clock is no stepped one: the runner takes its time for the wall's."""

    def __init__(self):
        super().__init__()
        stepped = self.time

        class Clock:
            def now(self):
                return stepped.now()

            def wait_until(self, time):
                stepped.wait_until(time)

        self.clock = Clock()
        self.wall = 0.0  # [s] passes only while a leaf blocks
        self.stopped = threading.Event()

    def stop(self):
        super().stop()
        if threading.current_thread().name == "watchdog":
            self.stopped.set()


class Blocks(Plan):
    """Sends a motion, and does not come back before the robot has been stopped."""

    def steps(self):
        world = self.context.world._inner
        self.world.send(HandTwist(side="left", twist_in_map=0.05 * np.eye(6)[2], duration=20.0))
        world.wall += LATE
        assert world.stopped.wait(30.0), "nobody has stopped the robot"
        yield
        yield


def test_a_leaf_that_blocks_does_not_leave_the_robot_moving():
    def build(context):
        return FailSafe("safe", Stage("A", None, Blocks("plan", context, outcomes=[True])), Release("let go", context))

    world = OnItsOwn()
    run = run_of(build, world, wall=lambda: world.wall)
    result = run.run()
    assert world.stopped.is_set()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.MOTION_BLOCKED.value)
    assert "no tick of the tree for 0.3 s" in result.reason
    event = next(event for event in run.trace.events if event["kind"] == "stopped")
    assert event["by"] == "watchdog"
    assert "watchdog" not in {thread.name for thread in threading.enumerate()}


def test_a_simulated_robot_waits_with_its_tree_and_needs_no_watchdog():
    run = run_of(lambda context: Plan("p", context, outcomes=[True]))
    assert isinstance(run, Run)
    assert run._watchdog is None


@pytest.mark.parametrize(("world", "times"), [(OnItsOwn, 1), (ScriptedWorld, 0)])
def test_what_a_first_tick_would_load_is_loaded_before_time_counts(monkeypatch, world, times):
    loaded = []
    monkeypatch.setattr(runner, "load", lambda: loaded.append(True))
    run_of(lambda context: Plan("p", context, outcomes=[True]), world())
    assert len(loaded) == times


def test_what_a_driver_raises_that_is_no_exception_does_not_end_the_watch():
    class Panic(BaseException):
        pass

    def stop():
        stops.append(bench.time)
        raise Panic

    stops = []
    bench = Bench(stop)
    bench.look_until(1.0)
    assert len(stops) > 3
    assert isinstance(bench.dog.error, Panic)

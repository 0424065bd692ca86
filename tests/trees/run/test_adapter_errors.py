"""Whatever a robot's adapter raises or says, the robot is told to stop and to open, and the run has an outcome."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from caretree.sim.log.logged_world import logged
from caretree.sim.scripted.clock import SteppedClock
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import GripperOpening
from caretree.skills.core.reasons import Reason

from ..planted import Look, run_of
from .at_rest import assert_at_rest, guarded_task

BREAKS_AT = 0.5  # [s]


class Adapter(ScriptedWorld):
    """Counts the stops; breaks after a while, as the test says."""

    def __init__(self):
        super().__init__()
        self.stops = 0
        self.asked = []

    @property
    def broken(self):
        return self.time.time > BREAKS_AT

    def stop(self):
        self.stops += 1
        super().stop()

    def send(self, command):
        self.asked.append(command)
        return super().send(command)

    @property
    def opened(self):
        sent = [each for each in self.asked if isinstance(each, GripperOpening)]
        return {each.side for each in sent if each.opening > 0.07}


class BrokenClock(SteppedClock):
    def __init__(self, world, answer):
        super().__init__(world._advance_to)
        self.world, self.answer = world, answer

    def now(self):
        return self.answer() if self.world.broken else self.world.time.time


def raises(error):
    def answer():
        raise error

    return answer


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (raises(RuntimeError("clock gone")), "RuntimeError: clock gone (at test_adapter_errors.py:"),
        (raises(TypeError("a bad message")), "the clock does not say the time: TypeError: a bad message"),
        (raises(SystemExit("no master")), "sys.exit('no master') was called"),
        (lambda: None, "the clock says None, but a time is asked for"),
        (lambda: float("nan"), "the clock says nan, but a time is asked for"),
        (lambda: "12", "the clock says '12', but a time is asked for"),
    ],
)
def test_a_clock_that_no_longer_tells_the_time_keeps_nothing_from_being_stopped(answer, said):
    world = Adapter()
    world.clock = BrokenClock(world, answer)
    run = run_of(lambda context: guarded_task(context, True, ticks=100), world)
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.WORLD_LOST.value)
    assert said in result.reason
    assert world.stops > 1
    assert world.opened == {"left", "right"}
    assert BREAKS_AT - 0.1 < result.sim_time_s < BREAKS_AT + 0.2, "the last time that was known"


def test_an_emergency_stop_that_is_no_yes_or_no_is_no_reason_to_leave_the_fingers_closed():
    class Odd(Adapter):
        def observe(self):
            seen = super().observe()
            return replace(seen, emergency_stop=np.array((False, False))) if self.broken else seen

    world = Odd()
    run = run_of(lambda context: guarded_task(context, True, ticks=100), world)
    result = run.run()
    assert result.outcome == "safe_stop"
    assert world.stops > 1
    assert world.opened == {"left", "right"}


@pytest.mark.parametrize("call", ["observe", "send", "stop", "wait_until"])
@pytest.mark.parametrize("error", [SystemExit(3), RuntimeError("driver broke")])
def test_an_adapter_that_raises_or_ends_the_program_ends_in_the_safe_stop(call, error):
    class Ends(Adapter):
        armed = True

        def __init__(self):
            super().__init__()
            self.clock = Waits(self)

        def fail(self, which):
            if which == call and self.broken and self.armed:
                raise error

        def observe(self):
            self.fail("observe")
            return super().observe()

        def send(self, command):
            if not isinstance(command, GripperOpening):
                self.fail("send")
            return super().send(command)

        def stop(self):
            super().stop()
            self.fail("stop")

    class Waits(SteppedClock):
        def __init__(self, world):
            super().__init__(world._advance_to)
            self.world = world

        def now(self):
            return self.world.time.time

        def wait_until(self, time):
            self.world.fail("wait_until")
            super().wait_until(time)

    world = Ends()
    run = run_of(lambda context: guarded_task(context, True, ticks=20), world)
    result = run.run()
    world.armed = False
    assert result.outcome == "safe_stop"
    said = "sys.exit(3) was called" if isinstance(error, SystemExit) else "RuntimeError: driver broke"
    assert f"{said} (at test_adapter_errors.py:" in result.reason
    assert world.stops > 1
    assert run.context.errors
    if call != "stop":
        assert world.opened == {"left", "right"}
        assert_at_rest(run, opened=call == "send")


def test_a_stop_that_raises_is_told_and_is_no_success():
    class Deaf(Adapter):
        def stop(self):
            super().stop()
            raise RuntimeError("no such service")

    result = run_of(lambda context: Look("looks", context, outcomes=[True]), Deaf()).run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith("The task is done. The robot did not come to rest: stop() failed: RuntimeError: no")
    assert result.reason.endswith(").")


def test_a_detail_ends_before_the_next_sentence():
    class Broken(Adapter):
        def observe(self):
            if self.broken:
                raise RuntimeError("driver broke")
            return super().observe()

    result = run_of(lambda context: guarded_task(context, True, ticks=100), Broken()).run()
    assert "driver broke (at test_adapter_errors.py:" in result.reason
    assert "). The robot did not come to rest" in result.reason


def test_an_error_of_an_adapter_is_told_in_a_whole_sentence():
    class Broken(Adapter):
        def send(self, command):
            if self.broken and not isinstance(command, GripperOpening):
                raise RuntimeError("driver broke")
            return super().send(command)

    result = run_of(lambda context: guarded_task(context, True, ticks=20), Broken()).run()
    assert result.reason.endswith(").")


def test_a_log_keeps_no_stop_from_a_robot_whose_clock_has_died():
    class Stops(Adapter):
        def stop(self):
            self.stops += 1

    world = Stops()
    world.clock = BrokenClock(world, lambda: None)
    result = run_of(lambda context: guarded_task(context, True, ticks=100), logged(world, None)).run()
    assert "the clock says None" in result.reason
    assert "stop() failed" not in result.reason
    assert world.opened == {"left", "right"}


def test_a_log_passes_on_what_is_no_observation():
    class Silent(Adapter):
        def observe(self) -> Any:
            return None if self.broken else super().observe()

    result = run_of(lambda context: guarded_task(context, True, ticks=100), logged(Silent(), None)).run()
    assert "observe gave no Observation, but None" in result.reason


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (
            lambda seen: replace(seen, arm_positions=seen.arm_positions[:, :6]),
            "arm_positions has shape (2, 6), but (2,",
        ),
        (
            lambda seen: replace(seen, gripper_opening=1000.0 * seen.gripper_opening),
            "gripper_opening is [85.0, 85.0]",
        ),
        (lambda seen: replace(seen, time=seen.time + 1.7e9), "s ahead of the clock"),
        (lambda seen: replace(seen, time=seen.time - 0.4), "the time of the joint state went back by 0."),
        (lambda seen: None, "observe gave no Observation, but None"),
        (lambda seen: vars(seen), "observe gave no Observation, but a dict"),
    ],
)
def test_an_observation_without_its_form_is_lost(wrong, said):
    class Wrong(Adapter):
        def observe(self):
            seen = super().observe()
            return wrong(seen) if self.broken else seen

    world = Wrong()
    result = run_of(lambda context: guarded_task(context, True, ticks=100), world).run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.SENSOR_LOST.value)
    assert said in result.reason
    assert world.opened == {"left", "right"}

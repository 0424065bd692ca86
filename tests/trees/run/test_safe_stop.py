"""Whatever ends a run, the robot stands still and holds nothing."""

from dataclasses import replace

import numpy as np
import py_trees
import pytest
from caretree.sim.errors import CaretreeError, RecordError
from caretree.sim.known_robots import robot_named
from caretree.sim.mechanics.gripper import GripperFacts
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import EmergencyStop, GripperOpening, HandTwist, SensorLost, WorldError
from caretree.skills.core.reasons import Reason
from caretree.trees.nodes.composers import fallback, sequence
from caretree.trees.nodes.decorators import FailSafe, Timeout
from py_trees.common import Status

from ..planted import Look, Plan, Release, run_of
from .at_rest import assert_at_rest, guarded_task


def test_an_error_in_a_plain_node_is_fenced_in():
    class Broken(py_trees.behaviour.Behaviour):
        def update(self):
            raise ZeroDivisionError("planted")

    def build(context):
        body = sequence("s", Plan("p", context, outcomes=[True]), Broken("broken"))
        return FailSafe("safe", body, Release("let go", context))

    run = run_of(build)
    run.world.send(GripperOpening(side="left", opening=0.0))
    result = run.run()
    assert result.outcome == "safe_stop"
    assert "planted" in result.reason
    assert "planted" in run.context.errors[0]
    assert run.root.made_safe is True
    assert_at_rest(run)


def test_an_error_in_terminate_does_not_keep_the_rest_from_stopping():
    class Broken(py_trees.behaviour.Behaviour):
        def update(self):
            return Status.RUNNING

        def terminate(self, new_status):
            raise ZeroDivisionError("planted")

    def build(context):
        both = py_trees.composites.Parallel(
            "both",
            py_trees.common.ParallelPolicy.SuccessOnAll(),
            [Broken("broken"), Plan("p", context, outcomes=[True], ticks=100)],
        )
        return FailSafe("safe", both, Release("let go", context))

    run = run_of(build)
    run.context.observers.append(lambda name, phase: name == "p" and phase == "step" and run.request_stop())
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.INTERRUPTED.value)
    assert_at_rest(run)


@pytest.mark.parametrize("tick", [1, 2, 4])
def test_an_interrupt_at_any_moment_ends_in_the_safe_stop(tick):
    count = [0]

    def interrupt(name, phase):
        count[0] += name == "p"
        if count[0] == tick:
            count[0] = 100
            raise KeyboardInterrupt

    run = run_of(lambda context: guarded_task(context, True))
    run.world.between_fingers["left"] = 0.02
    run.world.send(GripperOpening(side="left", opening=0.0))
    run.context.observers.append(interrupt)
    result = run.run()
    assert (result.outcome, result.reason) == ("safe_stop", "The operator interrupted the run. [operator]")
    assert run.root.made_safe is True
    assert_at_rest(run)


def test_a_second_interrupt_goes_straight_to_the_last_resort():
    def interrupt(name, phase):
        if (name, phase) in (("p", "step"), ("let go", "step")):
            raise KeyboardInterrupt

    run = run_of(lambda context: guarded_task(context, True))
    run.world.between_fingers["left"] = 0.02
    run.world.send(GripperOpening(side="left", opening=0.0))
    run.world.clock.wait_until(1.0)
    run.context.observers.append(interrupt)
    result = run.run()
    assert result.outcome == "safe_stop"
    assert run.root.made_safe is None
    assert_at_rest(run)


def test_without_a_fail_safe_the_runner_itself_stops_and_opens():
    run = run_of(lambda context: Plan("p", context, outcomes=[Reason.GRASP_MISSED]))
    run.world.send(GripperOpening(side="right", opening=0.0))
    assert run.run().outcome == "safe_stop"
    assert_at_rest(run)


def test_success_leaves_the_fingers_as_they_are():
    run = run_of(lambda context: guarded_task(context, True))
    run.world.send(GripperOpening(side="right", opening=0.0))
    assert run.run().outcome == "success"
    assert_at_rest(run, opened=False)
    assert run.world.observe().gripper_opening[1] < 0.01


def test_a_failing_safe_branch_is_followed_by_the_last_resort():
    def build(context):
        return FailSafe(
            "safe",
            Plan("p", context, outcomes=[Reason.GRASP_MISSED]),
            Plan("clumsy", context, outcomes=[Reason.UNREACHABLE]),
        )

    run = run_of(build)
    run.world.send(GripperOpening(side="right", opening=0.0))
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.GRASP_MISSED.value)
    assert run.root.made_safe is False
    assert_at_rest(run)


def test_senses_that_die_stop_the_run():
    class Blind(ScriptedWorld):
        def observe(self):
            if self.clock.now() > 0.5:
                raise SensorLost("no joint states arrive")
            return super().observe()

    run = run_of(
        lambda context: FailSafe("safe", Look("p", context, outcomes=[True], ticks=100), Release("let go", context)),
        Blind(),
    )
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.SENSOR_LOST.value)
    assert 0.9 < result.sim_time_s < 20.0
    assert "did not come to rest" in result.reason, "nobody can see whether it stands, so nobody may say so"


def test_fingers_of_a_robot_that_died_are_not_seen_to_let_go():
    class Died(ScriptedWorld):
        def observe(self):
            if self.clock.now() <= 0.5 or not hasattr(self, "last"):
                self.last = super().observe()
            return self.last

    run = run_of(
        lambda context: FailSafe("safe", Look("p", context, outcomes=[True], ticks=100), Release("let go", context)),
        Died(),
    )
    result = run.run()
    assert run.root.made_safe is False
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.SENSOR_STALE.value)
    assert "did not come to rest" in result.reason


def test_the_emergency_stop_ends_the_run_in_the_safe_stop():
    class Pressed(ScriptedWorld):
        @property
        def pressed(self):
            return self.clock.now() > 0.5

        def observe(self):
            return replace(super().observe(), emergency_stop=self.pressed)

        def send(self, command):
            if self.pressed:
                raise EmergencyStop("the red button on the base")
            return super().send(command)

    run = run_of(lambda context: guarded_task(context, True, ticks=100), Pressed())
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason == "The emergency stop is pressed: the fingers stay as they are. [robot]"
    assert result.stopped_from_outside
    assert result.sim_time_s < 2.0


def test_a_motion_that_will_not_stop_is_told():
    class Runaway(ScriptedWorld):
        def stop(self):
            pass

        def send(self, command):
            return super().send(replace(command, duration=1e3) if isinstance(command, HandTwist) else command)

    class Endless(Plan):
        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0.05, 0, 0, 0, 0, 0))))
            yield

    run = run_of(lambda context: fallback("f", Endless("runs on", context, outcomes=[True])), Runaway())
    result = run.run()
    assert result.outcome == "safe_stop"
    assert Reason.MOTION_BLOCKED.value in result.reason


def test_a_skill_that_never_lets_go_of_the_motion_ends_the_run_and_the_safe_branch_still_runs():
    class Clinging(Plan):
        def cancel(self):
            return False

    def build(context):
        body = fallback(
            "f",
            Timeout("in time", Clinging("clings", context, outcomes=[True], ticks=100), seconds=1.0),
            Plan("next", context, outcomes=[True]),
        )
        return FailSafe("safe", body, Release("let go", context))

    run = run_of(build)
    run.world.between_fingers["left"] = 0.02
    run.world.send(GripperOpening(side="left", opening=0.0))
    result = run.run()
    assert (result.outcome, result.reason) == ("safe_stop", f"{Reason.MOTION_BLOCKED.value} [clings] it does not stop")
    assert run.root.made_safe is True
    assert result.sim_time_s > 6.0, "it was given its patience"
    assert_at_rest(run)


def test_motion_that_belongs_to_no_skill_is_stopped_too():
    class Stray(py_trees.behaviour.Behaviour):
        def update(self):
            run.world.send(HandTwist(side="left", twist_in_map=np.array((0.05, 0, 0, 0, 0, 0)), duration=1e3))
            return Status.SUCCESS

    run = run_of(lambda context: Stray("stray"))
    assert run.run().outcome == "success"
    assert_at_rest(run, opened=False)


def test_a_record_that_cannot_be_written_ends_in_the_safe_stop_and_is_told():
    class Full:
        count = 0

        def event(self, event):
            self.count += 1
            if self.count > 3:
                raise RecordError("the disk is full")

    run = run_of(lambda context: guarded_task(context, True, ticks=50), recorder=Full())
    result = run.run()
    assert (result.outcome, result.reason) == ("safe_stop", f"{Reason.RECORD_LOST.value} [recorder] the disk is full")
    assert result.stopped_from_outside
    assert run.root.made_safe is True
    assert not run.context.errors
    assert_at_rest(run)


def test_an_error_in_showing_progress_ends_in_the_safe_stop_and_is_kept():
    def show(progress):
        raise ZeroDivisionError("planted")

    run = run_of(lambda context: guarded_task(context, True, ticks=50), on_progress=show)
    result = run.run()
    assert (result.outcome, result.reason) == ("safe_stop", f"{Reason.DISPLAY_LOST.value} [display] planted")
    assert run.root.made_safe is True
    assert len(run.context.errors) == 1
    assert "planted" in run.context.errors[0]


@pytest.mark.parametrize("error", [CaretreeError("planted"), OSError("planted"), SystemExit("planted")])
def test_no_error_of_a_tick_skips_the_safe_branch(error):
    class Broken(py_trees.behaviour.Behaviour):
        def update(self):
            raise error

    def build(context):
        body = sequence("s", Plan("p", context, outcomes=[True]), Broken("broken"))
        return FailSafe("safe", body, Release("let go", context))

    run = run_of(build)
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.INTERNAL_ERROR.value)
    assert "planted" in result.reason
    assert not result.stopped_from_outside
    assert run.root.made_safe is True


@pytest.mark.parametrize("stroke", [0.05, 0.14])
def test_fingers_of_any_stroke_are_opened_as_far_as_they_go_and_no_farther(stroke):
    """A gripper of 0.14 m used to be closed to 0.085 m onto what stood between its fingers."""
    robot = replace(robot_named(), gripper=GripperFacts(stroke=stroke))

    class Strict(ScriptedWorld):
        def send(self, command):
            if isinstance(command, GripperOpening) and command.opening > stroke:
                raise WorldError(f"this gripper opens to {stroke} m")
            return super().send(command)

    world = Strict(robot=robot)
    run = run_of(lambda context: Plan("p", context, outcomes=[True], ticks=100), world)
    world._opening[:] = world._opening_goal[:] = 0.01
    run.request_stop()
    result = run.run()
    assert "did not come to rest" not in result.reason, result
    assert run.guard.observe().gripper_opening == pytest.approx((stroke, stroke), abs=1e-3)
    assert result.sim_time_s < 3.0


def test_a_stop_that_fails_once_as_a_skill_settles_does_not_cost_the_safe_branch():
    class Busy(ScriptedWorld):
        failures = 3

        def stop(self):
            if self.failures and self.clock.now() > 0.2:
                self.failures -= 1
                raise RuntimeError("busy")
            super().stop()

    class Moves(Plan):
        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0.01, 0, 0, 0, 0, 0)), duration=1.0))
            yield from self.wait(0.3)

    world = Busy()

    def build(context):
        body = sequence("s", Moves("moves", context, outcomes=[True]), Plan("fails", context, outcomes=[False]))
        return FailSafe("safely", body, Release("release", context))

    run = run_of(build, world)
    result = run.run()
    assert world.failures < 3
    assert result.sim_time_s < 10.0, "the safe branch waited for a motion that had been forgotten"


def test_what_is_no_exception_does_not_cut_the_safe_stop_short():
    class Panic(BaseException):
        pass

    class Panics(ScriptedWorld):
        left = 3

        def stop(self):
            if self.left:
                self.left -= 1
                raise Panic("in the driver")
            super().stop()

    world = Panics()
    world._opening[:] = world._opening_goal[:] = 0.01
    run = run_of(lambda context: Plan("p", context, outcomes=[False]), world)
    assert run.run().outcome == "safe_stop"
    assert (run.guard.observe().gripper_opening > 0.07).all()

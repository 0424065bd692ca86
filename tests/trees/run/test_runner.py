from dataclasses import replace
from pathlib import Path

import numpy as np
import py_trees
import pytest
from caretree.sim.errors import CaretreeError, RecordError
from caretree.sim.faults import SETTLED, FaultSpec, FaultyWorld
from caretree.sim.record.record import read_run
from caretree.sim.record.recorder import Recorder
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import EmergencyStop, GripperOpening, HandTwist, SensorLost
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.limits import Limits
from caretree.trees.nodes.composers import fallback, reactive_fallback, sequence
from caretree.trees.nodes.decorators import FailSafe, Retry, Stage, Timeout
from caretree.trees.run.runner import run as run_task
from caretree.trees.run.task import load_task
from py_trees.common import Status

from ..planted import Look, Plan, Release, run_of, task_of


def assert_at_rest(run, opened=True):
    world = run.world
    before = world.observe().arm_positions
    world.clock.wait_until(world.clock.now() + 1.0)
    assert np.abs(before - world.observe().arm_positions).max() < 5e-3  # [rad] what counts as still may creep on
    if opened:
        assert world.observe().gripper_opening.min() > 0.07


def guarded_task(context, outcome, ticks=5):
    body = Stage("A", None, Plan("p", context, outcomes=[outcome], ticks=ticks))
    return FailSafe("safe", body, Release("let go", context))


def test_wave_runs_on_the_scripted_world():
    result = run_task(load_task("wave"), ScriptedWorld(seed=0))
    assert result.outcome == "success"
    assert [(stage.name, stage.status) for stage in result.stages] == [("wave", "success"), ("hold", "success")]
    assert result.sim_time_s > 5.0


def test_the_same_seed_gives_the_same_hash_and_another_world_another():
    first, again = (run_task(load_task("wave"), ScriptedWorld(seed=0), seed=0) for _ in range(2))
    assert first.trace_hash == again.trace_hash
    assert run_task(load_task("wave"), ScriptedWorld(seed=0), params={"side": "right"}).trace_hash != first.trace_hash


def test_every_failure_is_told_even_one_that_takes_no_time():
    told = []

    def build(context):
        blink = Look("blink", context, outcomes=[Reason.NOTHING_SEEN], ticks=0)
        return FailSafe("safe", Retry("again", blink, attempts=3), Release("let go", context))

    run_of(build, on_progress=told.append).run()
    blinks = [line for line in told if line.name == "blink"]
    assert [line.status for line in blinks] == ["failure"] * 3
    assert blinks[0].message == Reason.NOTHING_SEEN.value, "the line says whose failure it is; the message need not"


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

    run = run_of(lambda context: guarded_task(context, True, ticks=100), Hangs(), limits=Limits(wait=0.05))
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


def test_a_motion_that_will_not_stop_is_told():
    class Runaway(ScriptedWorld):
        def stop(self):
            pass

    class Endless(Plan):
        def steps(self):
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0.05, 0, 0, 0, 0, 0)), duration=1e3))
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


def test_the_higher_branch_waits_for_the_lower_ones_motion():
    """Selector(memory=False) starts the higher branch before it stops the lower one: only one may command."""
    commands = []

    def build(context):
        class Urgent(Plan):
            def steps(self):
                assert context.guard.still(), "the lower branch still moves"
                commands.append("urgent")
                yield

        ask = [Reason.PRECONDITION] * 3 + [True]
        urgent = sequence(
            "urgent branch", Look("asked", context, outcomes=ask, ticks=0), Urgent("urgent", context, outcomes=[True])
        )
        lower = Plan("lower", context, outcomes=[True], ticks=100)
        # composers refuse this tree; py_trees does not
        return py_trees.composites.Selector("watch", memory=False, children=[urgent, lower])

    run = run_of(build)
    assert run.run().outcome == "success"
    assert commands == ["urgent"]
    assert not run.context.errors


def test_watching_a_condition_preempts_a_motion():
    def build(context):
        return reactive_fallback(
            "w",
            Look("seen", context, outcomes=[Reason.NOTHING_SEEN] * 3 + [True], ticks=0),
            Plan("move", context, outcomes=[True], ticks=100),
        )

    run = run_of(build)
    assert run.run().outcome == "success"
    assert_at_rest(run, opened=False)


def test_progress_tells_stages_before_their_skills():
    told = []
    run_task(load_task("wave"), ScriptedWorld(), on_progress=told.append)
    lines = [(each.kind, each.name, each.status) for each in told]
    assert lines[:2] == [("stage", "wave", "running"), ("skill", "hand up", "running")]
    assert lines[-1] == ("stage", "hold", "success")
    assert [each.time for each in told] == sorted(each.time for each in told)


def test_progress_tells_what_was_stopped():
    told = []
    run = run_of(lambda context: guarded_task(context, True, ticks=50), on_progress=told.append)
    run.context.observers.append(lambda name, phase: phase == "step" and run.request_stop())
    run.run()
    lines = [(each.name, each.status) for each in told]
    assert ("p", "stopped") in lines
    assert ("A", "stopped") in lines
    assert lines.index(("p", "stopped")) < lines.index(("let go", "success"))


def test_the_recorder_gets_every_event_and_the_hash(tmp_path: Path):
    recorder = Recorder(tmp_path / "run", task="wave", seed=0, world="scripted")
    result = run_task(load_task("wave"), ScriptedWorld(), recorder=recorder)
    recorder.finish(result)
    record = read_run(tmp_path / "run")
    assert record["trace_hash"] == result.trace_hash
    assert (tmp_path / "run" / "trace.jsonl").read_text().count("\n") > 10


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


def test_a_run_has_a_longest_time():
    from caretree.trees.guard.limits import Limits

    run = run_of(lambda context: guarded_task(context, True, ticks=10**6), limits=Limits(run=3.0))
    result = run.run()
    assert result.reason.startswith(Reason.TIMEOUT.value)
    assert result.sim_time_s < 5.0


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


def test_skills_and_trees_run_where_truth_cannot_be_read():
    class Secretive(ScriptedWorld):
        @property
        def truth(self):
            raise AssertionError("somebody read the truth")

    assert run_task(load_task("wave"), Secretive()).outcome == "success"
    run = run_of(lambda context: guarded_task(context, True), Secretive())
    with pytest.raises(AttributeError):
        _ = run.context.world.truth
    with pytest.raises(AttributeError):
        _ = run.root.body.body.world.truth


def test_a_task_may_not_take_unknown_parameters():
    with pytest.raises(CaretreeError, match=r"planted.py:\d+: task 'planted': build\(context, ...\) got an unexpected"):
        run_task(task_of(lambda context: Release("r", context)), ScriptedWorld(), params={"size": 3})

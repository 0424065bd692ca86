from pathlib import Path

import py_trees
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.record.record import read_run
from caretree.sim.record.recorder import Recorder
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.limits import Limits
from caretree.trees.nodes.composers import reactive_fallback, sequence
from caretree.trees.run.runner import run as run_task
from caretree.trees.run.task import load_task

from ..planted import Look, Plan, Release, run_of, task_of
from .at_rest import assert_at_rest, guarded_task


def test_wave_runs_on_the_scripted_world():
    result = run_task(load_task("wave"), ScriptedWorld(seed=0))
    assert result.outcome == "success"
    assert [(stage.name, stage.status) for stage in result.stages] == [("wave", "success"), ("hold", "success")]
    assert result.sim_time_s > 5.0


def test_the_same_seed_gives_the_same_hash_and_another_world_another():
    first, again = (run_task(load_task("wave"), ScriptedWorld(seed=0), seed=0) for _ in range(2))
    assert first.trace_hash == again.trace_hash
    assert run_task(load_task("wave"), ScriptedWorld(seed=0), params={"side": "right"}).trace_hash != first.trace_hash


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


def test_the_recorder_gets_every_event_and_the_hash(tmp_path: Path):
    recorder = Recorder(tmp_path / "run", task="wave", seed=0, world="scripted")
    result = run_task(load_task("wave"), ScriptedWorld(), recorder=recorder)
    recorder.finish(result)
    record = read_run(tmp_path / "run")
    assert record["trace_hash"] == result.trace_hash
    assert (tmp_path / "run" / "trace.jsonl").read_text().count("\n") > 10


def test_a_run_has_a_longest_time():

    run = run_of(lambda context: guarded_task(context, True, ticks=10**6), limits=Limits(run=3.0))
    result = run.run()
    assert result.reason.startswith(Reason.TIMEOUT.value)
    assert result.sim_time_s < 5.0


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

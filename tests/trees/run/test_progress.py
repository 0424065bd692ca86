from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.reasons import Reason
from caretree.trees.nodes.decorators import FailSafe, Retry
from caretree.trees.run.runner import run as run_task
from caretree.trees.run.task import load_task

from ..planted import Look, Release, run_of
from .at_rest import guarded_task


def test_every_failure_is_told_even_one_that_takes_no_time():
    told = []

    def build(context):
        blink = Look("blink", context, outcomes=[Reason.NOTHING_SEEN], ticks=0)
        return FailSafe("safe", Retry("again", blink, attempts=3), Release("let go", context))

    run_of(build, on_progress=told.append).run()
    blinks = [line for line in told if line.name == "blink"]
    assert [line.status for line in blinks] == ["failure"] * 3
    assert blinks[0].message == Reason.NOTHING_SEEN.value, "the line says whose failure it is; the message need not"


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

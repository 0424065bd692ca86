import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.core.ports import Key
from caretree.skills.core.reasons import Reason
from caretree.trees.nodes.composers import TreeError, fallback, sequence
from caretree.trees.nodes.decorators import Condition, FailSafe, RecoverBy, Retry, Stage, Timeout
from caretree.trees.run.task import TaskError

from ..planted import Look, Plan, Release, run_of


def test_retry_counts_attempts_and_forgets_their_data():
    seen = []

    def build(context):
        first = Look("first", context, outcomes=[True], made=Key("made"))
        second = Plan("second", context, outcomes=[Reason.GRASP_MISSED, Reason.GRASP_MISSED, True])
        asked = Condition("board", lambda context: seen.append("made" in context.board) or True)
        return Retry("retry", sequence("body", asked, first, second), attempts=3)

    run = run_of(build)
    assert run.run().outcome == "success"
    assert run.root.tried == 3
    assert seen == [False, False, False], "no attempt sees what the one before has written"


def test_a_recovery_is_a_function_not_a_node():
    def build(context):
        shake = Look("shake", context, outcomes=[True])
        return RecoverBy("r", Look("p", context, outcomes=[True]), {Reason.GRASP_MISSED: shake})

    with pytest.raises(TaskError, match="a recovery of 'r' is the node 'shake', but a function that builds a subtree"):
        run_of(build)


def test_retry_fails_with_the_last_reason():
    run = run_of(
        lambda context: Retry(
            "retry", Plan("p", context, outcomes=[Reason.GRASP_MISSED, Reason.MULTI_LAYER]), attempts=2
        )
    )
    result = run.run()
    assert result.outcome == "safe_stop", "a tree that moves without a fail-safe gets the runner's last resort"
    assert result.reason.startswith(Reason.MULTI_LAYER.value)


@pytest.mark.parametrize(
    ("body", "recovery", "outcome", "ran"),
    [
        ([True], True, "success", {"shake": 0, "look": 0}),
        ([Reason.MULTI_LAYER, True], True, "success", {"shake": 1, "look": 0}),
        ([Reason.ARM_LOST, Reason.MULTI_LAYER, True], True, "success", {"shake": 1, "look": 1}),
        ([Reason.UNREACHABLE, True], True, "safe_stop", {"shake": 0, "look": 0}),
        ([Reason.MULTI_LAYER], True, "safe_stop", {"shake": 2, "look": 0}),
        ([Reason.MULTI_LAYER, True], Reason.TIMEOUT, "safe_stop", {"shake": 1, "look": 0}),
    ],
)
def test_recoveries_are_chosen_by_reason(body, recovery, outcome, ran):
    def build(context):
        return RecoverBy(
            "grasp",
            Plan("body", context, outcomes=body),
            {
                Reason.MULTI_LAYER: lambda: Plan("shake", context, outcomes=[recovery]),
                Reason.ARM_LOST: lambda: Look("look", context, outcomes=[True]),
            },
            attempts=3,
        )

    run = run_of(build)
    result = run.run()
    assert result.outcome == outcome
    assert {leaf.name: leaf.rounds for leaf in run.root.children[1:]} == ran
    if outcome != "success":
        assert result.reason.startswith(body[0].value)
    if recovery is Reason.TIMEOUT:
        assert "the recovery failed: It took longer than allowed. [shake]" in result.reason


def test_reasons_with_the_same_function_share_a_recovery():
    def build(context):
        def shake():
            return Plan("shake", context, outcomes=[True])

        return RecoverBy(
            "grasp",
            Plan("body", context, outcomes=[Reason.MULTI_LAYER, Reason.ARM_LOST, True]),
            dict.fromkeys((Reason.MULTI_LAYER, Reason.ARM_LOST), shake),
            attempts=3,
        )

    run = run_of(build)
    assert run.run().outcome == "success"
    assert [(leaf.name, leaf.rounds) for leaf in run.root.children[1:]] == [("shake", 2)]


def test_timeout_uses_the_worlds_clock_and_stops_the_body():
    def build(context):
        return fallback(
            "f",
            Timeout("in time", Plan("slow", context, outcomes=[True], ticks=100), seconds=1.0),
            Plan("instead", context, outcomes=[True]),
        )

    run = run_of(build)
    result = run.run()
    assert result.outcome == "success"
    commanded = [event["t"] for event in run.trace.events if event["kind"] == "command"]
    assert 1.0 < result.sim_time_s < 2.0
    assert commanded
    assert run.root.children[0].failure.reason == Reason.TIMEOUT


def test_stage_keeps_the_account():
    def build(context):
        body = Retry("retry", Plan("p", context, outcomes=[Reason.GRASP_MISSED, True]), attempts=3)
        return sequence(
            "task",
            Stage("A", lambda context: True, body),
            Stage("B", lambda context: "x" in context.board, Plan("q", context, outcomes=[True])),
            Stage("C", None, Plan("r", context, outcomes=[True])),
        )

    run = run_of(build)
    a, b, c = run.run().stages
    assert (a.name, a.status, a.attempts, a.t_start, a.reason) == ("A", "success", 2, 0.0, "")
    assert a.t_end > 0.1
    assert (b.status, b.attempts) == ("failure", 1)
    assert b.reason.startswith(Reason.PRECONDITION.value)
    assert (c.status, c.attempts, c.t_start, c.t_end) == ("not_run", 0, None, None)


def test_a_stage_that_is_cut_short_stays_running_in_the_record():
    def build(context):
        return Stage("A", None, Plan("p", context, outcomes=[True], ticks=100))

    run = run_of(build)
    run.context.observers.append(lambda name, phase: phase == "step" and run.request_stop())
    (stage,) = run.run().stages
    assert stage.status == "running"
    assert stage.t_end is not None


def test_fail_safe_runs_its_branch_and_keeps_the_reason():
    run = run_of(
        lambda context: FailSafe(
            "safe", Plan("p", context, outcomes=[Reason.SLEEVE_CAUGHT]), Release("release", context)
        )
    )
    result = run.run()
    assert result.outcome == "safe_stop"
    assert result.reason.startswith(Reason.SLEEVE_CAUGHT.value)
    assert run.root.made_safe is True
    assert run.world.observe().gripper_opening.min() > 0.07


def test_a_condition_takes_any_truth_value():
    import numpy as np

    run = run_of(lambda context: Condition("c", lambda context: np.bool_(True)))
    assert run.run().outcome == "success"
    run = run_of(lambda context: Condition("c", lambda context: context.board.get("nothing")))
    assert "'nothing' has not been written" in run.run().reason


def test_wrong_numbers_are_refused():

    def unseen(context):
        raise PerceptionFailure(Problem.NOTHING_SEEN, "trunk")

    run = run_of(lambda context: Condition("c", unseen, Reason.NOTHING_SEEN))
    assert run.run().outcome != "success"
    assert run.root.failure.reason == Reason.NOTHING_SEEN
    assert not run.context.errors, "what is not seen is no programming error"
    condition = Condition("c", lambda context: True)
    with pytest.raises(TreeError, match="attempts of 'r' is 0"):
        Retry("r", condition, attempts=0)
    with pytest.raises(TreeError, match="seconds of 't' is -1"):
        Timeout("t", Condition("c", lambda context: True), seconds=-1)
    with pytest.raises(TreeError, match="map a Reason to a function"):
        RecoverBy("b", Condition("c", lambda context: True), {"multi_layer": lambda: None})

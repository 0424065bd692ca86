import json

import numpy as np
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.reasons import Reason
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.decorators import FailSafe
from caretree.trees.run.trace import canonical, hash_of, paths_of, rounded

from ..planted import Look, Plan, Release, run_of


def test_numbers_are_rounded_to_plain_json():
    value = {"a": np.float64(1.00004), "b": np.array((0.1 + 0.2, -1e-9)), "c": (np.int64(3), True, None, "x")}
    assert rounded(value) == {"a": 1.0, "b": [0.3, 0.0], "c": [3, True, None, "x"]}
    assert json.dumps(rounded(-1e-9)) == "0.0"


def test_brothers_of_one_name_have_different_paths():
    run = run_of(lambda context: sequence("s", *(Look("a", context, outcomes=[True]) for _ in range(2))))
    assert list(paths_of(run.root).values()) == ["s", "s/a", "s/a#2"]


def test_the_trace_tells_statuses_reasons_and_commands_in_order():
    run = run_of(
        lambda context: FailSafe("safe", Plan("p", context, outcomes=[Reason.ARM_LOST]), Release("r", context))
    )
    result = run.run()
    nodes = [(event["node"], event["status"]) for event in run.trace.events if event["kind"] == "node"]
    assert nodes[:2] == [("safe/p", "RUNNING"), ("safe", "RUNNING")]
    assert ("safe/p", "FAILURE") in nodes
    of_plan = [event for event in run.trace.events if event.get("node") == "safe/p"]
    assert [event["reason"] for event in of_plan if "reason" in event] == ["ARM_LOST"]
    twists = [event for event in run.trace.events if event["kind"] == "command" and event["what"] == "twist"]
    assert [event["t"] for event in twists] == [0.0, 0.0667]
    assert run.trace.events[-1] == {
        "t": rounded(result.sim_time_s),
        "kind": "end",
        "outcome": "safe_stop",
        "reason": "ARM_LOST",
    }
    times = [event["t"] for event in run.trace.events]
    assert times == sorted(times)
    assert result.trace_hash == hash_of(run.trace.events)


def test_the_hash_leaves_free_text_out_and_nothing_else():
    event = {"t": 1.0, "kind": "node", "node": "a", "status": "FAILURE", "reason": "TIMEOUT", "detail": "3 s"}
    assert canonical(event) == canonical({**event, "detail": "3.1 s"})
    for key, value in (("t", 1.1), ("node", "b"), ("status", "SUCCESS"), ("reason", "ARM_LOST")):
        assert hash_of([event]) != hash_of([{**event, key: value}])


def test_a_different_command_gives_another_hash():
    runs = [
        run_of(lambda context, ticks=ticks: Plan("p", context, outcomes=[True], ticks=ticks), ScriptedWorld())
        for ticks in (2, 2, 3)
    ]
    hashes = {run.run().trace_hash for run in runs}
    assert len(hashes) == 2

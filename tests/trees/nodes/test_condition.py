import pytest
from caretree.sim.world import SensorStale
from caretree.skills.core.ports import Key
from caretree.skills.core.reasons import Reason
from caretree.trees.nodes.composers import TreeError, sequence
from caretree.trees.nodes.condition import Condition, inputs_of
from caretree.trees.proof.check import check

from ..planted import Look, run_of, task_of


def longer(context, length: float, least: float = 0.5):
    return length > least


@pytest.mark.parametrize(("least", "outcome"), [(0.5, "success"), (2.0, "safe_stop")])
def test_a_test_is_given_constants_and_values_of_keys(least, outcome):
    def build(context):
        asked = Condition("long", longer, Reason.GRASP_MISSED, length=Key("made"), least=least)
        return sequence("s", Look("look", context, outcomes=[True], made=Key("made")), asked)

    run = run_of(build)
    assert run.root.children[1].reads() == {"length": Key("made")}
    assert inputs_of(longer) == {"length": float, "least": float}
    result = run.run()
    assert result.outcome == outcome
    if outcome != "success":
        assert run.root.children[1].failure.reason is Reason.GRASP_MISSED


def test_a_sense_that_is_lost_is_no_defect_of_a_condition():
    def sees(context):
        raise SensorStale("the head image is 2 s old")

    run = run_of(lambda context: Condition("sees", sees))
    run.run()
    assert run.root.failure.reason is Reason.SENSOR_STALE
    assert not run.context.errors


def test_check_finds_what_a_condition_reads_unwritten_and_of_another_type():
    def unwritten(context):
        return Condition("long", longer, length=Key("made"))

    def text(context, length: str):
        return True

    def mistyped(context):
        asked = Condition("long", text, length=Key("made"))
        return sequence("s", Look("look", context, outcomes=[True], made=Key("made")), asked)

    found = check(task_of(unwritten)).findings
    assert found[0].startswith("long: input length reads 'made', which is not written on every way to here")
    assert "long reads 'made', which has not been written" in found[1]
    assert check(task_of(mistyped)).findings == ["s/long: input length takes str, but 'made' holds int"]


@pytest.mark.parametrize("given", [{}, {"length": 1.0, "width": 2.0}])
def test_what_the_test_does_not_take_is_refused(given):
    with pytest.raises(TreeError, match=r"is called with the context[,:]"):
        Condition("c", longer, **given)

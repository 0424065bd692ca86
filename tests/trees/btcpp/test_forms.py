import py_trees
import pytest
from caretree.skills.core.reasons import Reason
from caretree.trees.btcpp.forms import BY_TAG, ELSEWHERE, FORMS, form_of, whole
from caretree.trees.btcpp.values import ValueTextError
from caretree.trees.nodes.condition import Condition
from caretree.trees.nodes.decorators import RecoverBy, Stage, Timeout


def leaves(count):
    return [Condition(f"c{n}", lambda context: True) for n in range(count)]


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.tag)
def test_what_a_form_makes_fits_it_alone_and_is_made_again(form):
    needed = {"num_attempts": "3", "msec": "1500", "reasons": "GRASP_MISSED"}
    given = {port.name: port.default or needed[port.name] for port in form.ports}
    node = form.make("n", leaves(form.least), given)
    assert [each.tag for each in FORMS if each.fits(node)] == [form.tag]
    assert form_of(node) is form
    attributes = form.attributes(node)
    assert set(attributes) == {port.name for port in form.ports}
    again = form.make("n", leaves(form.least), attributes)
    assert type(again) is type(node)
    assert form.attributes(again) == attributes
    assert [part.name for part in form.parts(again)] == [f"c{n}" for n in range(form.least)]


def test_the_precondition_of_a_stage_comes_first():
    stage = BY_TAG["Stage"].make("s", leaves(2), {})
    assert isinstance(stage, Stage)
    assert (stage.precondition.name, stage.body.name) == ("c0", "c1")
    assert [part.name for part in BY_TAG["Stage"].parts(stage)] == ["c0", "c1"]


def test_each_recovery_has_its_reasons():
    node = BY_TAG["RecoverBy"].make("r", leaves(3), {"reasons": "GRASP_MISSED, NOTHING_SEEN;ARM_LOST", "attempts": "4"})
    assert isinstance(node, RecoverBy)
    assert {reason: tree.name for reason, tree in node.recoveries.items()} == {
        Reason.GRASP_MISSED: "c1",
        Reason.NOTHING_SEEN: "c1",
        Reason.ARM_LOST: "c2",
    }
    assert node.attempts == 4


@pytest.mark.parametrize(
    ("tag", "count", "attributes", "said"),
    [
        ("RecoverBy", 2, {}, "there is no reason ''"),
        ("RecoverBy", 2, {"reasons": "ARM_LOS"}, "did you mean ARM_LOST?"),
        ("RecoverBy", 3, {"reasons": "ARM_LOST"}, "names 1 groups, but 2 recoveries"),
        ("RecoverBy", 3, {"reasons": "ARM_LOST;ARM_LOST"}, "ARM_LOST is named twice"),
        ("Parallel", 3, {"success_count": "2"}, "success_count is 2"),
        ("Parallel", 3, {"failure_count": "2"}, "failure_count is 2"),
        ("Timeout", 1, {}, "msec is not given"),
        ("Timeout", 1, {"msec": "1.5"}, "msec is 1.5"),
    ],
)
def test_attributes_that_will_not_do_are_refused(tag, count, attributes, said):
    with pytest.raises(ValueTextError) as refused:
        BY_TAG[tag].make("n", leaves(count), attributes)
    assert said in str(refused.value)


def test_a_time_that_is_no_whole_number_of_milliseconds_is_not_written():
    form = BY_TAG["Timeout"]
    with pytest.raises(ValueTextError, match="whole milliseconds"):
        form.attributes(Timeout("t", leaves(1)[0], seconds=0.0001234))


def test_a_default_stands_in():
    assert whole({}, "n", 3) == 3


def test_nodes_without_a_counterpart_are_none_that_there_are():
    assert not ELSEWHERE.keys() & BY_TAG.keys()
    assert form_of(py_trees.behaviours.Running("r")) is None

"""Why a subtree failed: the child that decided says so."""

from types import SimpleNamespace

import py_trees
from caretree.sim.world import SensorLost
from caretree.skills.core.reasons import Failure, Reason
from caretree.trees.nodes.composers import fallback, sequence
from caretree.trees.nodes.condition import Condition
from caretree.trees.nodes.decorators import Retry
from caretree.trees.nodes.failures import cause_of, failure_of
from py_trees.common import Status


class Leaf(py_trees.behaviour.Behaviour):
    """Ends as it is told, with a reason of its own."""

    def __init__(self, name, reason=None):
        super().__init__(name)
        self.reason, self.failure = reason, None

    def update(self):
        if self.reason is None:
            return Status.SUCCESS
        self.failure = Failure(self.reason, "", self.name)
        return Status.FAILURE


def failed(node):
    """The name of the leaf and its reason after one tick."""
    node.tick_once()
    assert node.status == Status.FAILURE
    found = failure_of(node)
    return found.node, found.reason


def test_a_sequence_reports_the_child_that_failed():
    leaves = [Leaf("well"), Leaf("lost", Reason.COMMAND_LOST), Leaf("never ran", Reason.TIMEOUT)]
    assert failed(py_trees.composites.Sequence("all", memory=True, children=leaves)) == ("lost", Reason.COMMAND_LOST)


def test_a_fallback_reports_its_last_child():
    leaves = [Leaf("first", Reason.GRASP_MISSED), Leaf("last", Reason.UNREACHABLE)]
    assert failed(py_trees.composites.Selector("one of", memory=True, children=leaves)) == ("last", Reason.UNREACHABLE)


def test_the_reason_comes_up_from_any_depth():
    inner = py_trees.composites.Sequence("inner", memory=True, children=[Leaf("deep", Reason.NOTHING_SEEN)])
    outer = py_trees.composites.Selector("outer", memory=True, children=[Leaf("shallow", Reason.TIMEOUT), inner])
    assert failed(outer) == ("deep", Reason.NOTHING_SEEN)


def ways(*last):
    """A fallback whose first way misses, tried twice, inside a sequence."""
    missed = Retry("twice", Leaf("grasp", Reason.GRASP_MISSED), attempts=2)
    return sequence("all", fallback("one of", missed, *last))


def asks(name, answer=lambda context: False):
    return Condition(name, answer, Reason.MOTION_BLOCKED)


def caused(node):
    """The names that `failure_of` and `cause_of` tell."""
    for each in node.iterate():
        if isinstance(each, Condition):
            each.bind(SimpleNamespace(board=None))
    while node.status not in (Status.FAILURE, Status.SUCCESS):
        node.tick_once()
    assert node.status == Status.FAILURE
    return failure_of(node).node, cause_of(node).node


def test_an_alternative_that_did_not_apply_is_not_the_cause():
    assert caused(ways(sequence("let go", asks("is down"), Leaf("open")))) == ("is down", "grasp")
    assert caused(ways(asks("good enough"))) == ("good enough", "grasp")
    assert caused(fallback("one of", asks("a"), asks("b"))) == ("b", "b")


def test_an_alternative_that_began_is_the_cause():
    began = sequence("let go", Leaf("open"), asks("is open"))
    assert caused(ways(began)) == ("is open", "is open")
    assert caused(ways(Leaf("other", Reason.UNREACHABLE))) == ("other", "other")


def test_a_question_that_could_not_be_answered_is_the_cause():
    def blind(context):
        raise SensorLost("head")

    assert caused(ways(asks("is down", blind))) == ("is down", "is down")


def test_a_wrapper_s_own_failure_is_the_cause():
    class Late(Leaf):
        def __init__(self, child):
            super().__init__("late", Reason.TIMEOUT)
            self.children = [child]

    late = Late(Leaf("grasp", Reason.GRASP_MISSED))
    late.children[0].tick_once()
    late.tick_once()
    assert cause_of(late).reason == Reason.TIMEOUT


def test_a_node_that_gives_no_reason_is_an_error_with_its_name():
    assert failed(py_trees.behaviours.Failure("mute")) == ("mute", Reason.INTERNAL_ERROR)

"""Why a subtree failed: the child that decided says so."""

import py_trees
from caretree.skills.core.reasons import Failure, Reason
from caretree.trees.nodes.failures import failure_of
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


def test_a_node_that_gives_no_reason_is_an_error_with_its_name():
    assert failed(py_trees.behaviours.Failure("mute")) == ("mute", Reason.INTERNAL_ERROR)

import py_trees
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.nodes.composers import TreeError, fallback, parallel, reactive_fallback, sequence


class Move(Skill):
    pass


class Look(Skill):
    commands = False


@pytest.fixture
def context():
    guard = GuardedWorld(ScriptedWorld())
    return Context(world=guard, guard=guard)


def test_what_py_trees_lets_pass_is_refused(context):
    with pytest.raises(TreeError, match="policy of 'both' is 'al', but one of all, one"):
        parallel("both", Look("a", context), policy="al")
    with pytest.raises(TypeError):
        sequence("s", Look("a", context), memory="yes")
    with pytest.raises(TreeError, match="'s' has no children"):
        sequence("s")
    with pytest.raises(TreeError, match="first argument is its name"):
        fallback(Look("a", context))
    with pytest.raises(TreeError, match="a child of 's' is 'a'"):
        sequence("s", "a")


def test_a_node_has_one_place(context):
    child = Look("a", context)
    with pytest.raises(TreeError, match="same child twice"):
        sequence("s", child, child)
    parent = sequence("s", child)
    with pytest.raises(TreeError, match="'a' already belongs to 's'"):
        sequence("t", child)
    with pytest.raises(TreeError, match="already belongs"):
        sequence("t", parent.children[0])


def test_two_commanders_in_one_tick_cannot_be_built(context):
    with pytest.raises(TreeError, match="'a' and 'b' in 'both' would wait for each other"):
        parallel("both", Move("a", context), Move("b", context))
    with pytest.raises(TreeError, match="could let 'a' and 's' command in one tick"):
        reactive_fallback("w", Move("a", context), sequence("s", Look("l", context), Move("b", context)))
    assert reactive_fallback("w", Look("l", context), Move("m", context)).memory is False


def test_they_are_py_trees_own_composites(context):
    assert isinstance(sequence("s", Look("a", context)), py_trees.composites.Sequence)
    assert fallback("f", Look("a", context)).memory is True
    both = parallel("p", Look("a", context), Look("b", context), policy="one")
    assert isinstance(both.policy, py_trees.common.ParallelPolicy.SuccessOnOne)

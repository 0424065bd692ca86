import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import Skill, SkillFailure
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Key
from caretree.skills.core.reasons import Reason
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.condition import Condition
from caretree.trees.proof.leaves import leaf_findings
from caretree.trees.run.trace import paths_of

from ..planted import Look


def context_of():
    guard = GuardedWorld(ScriptedWorld())
    return Context(world=guard, guard=guard)


def findings(leaf, context):
    root = sequence("s", leaf)
    return leaf_findings(root, context, paths_of(root))


@pytest.fixture(autouse=True)
def registry():
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


def test_a_leaf_of_another_run_is_found():
    context = context_of()
    assert findings(Look("look", context, outcomes=[True]), context) == []
    (found,) = findings(Look("look", context_of(), outcomes=[True]), context)
    assert found.startswith("s/look: it was built with another context")


def test_a_skill_that_does_nothing_is_found():
    empty = type("Empty", (Skill,), {})
    half = type("Half", (Skill,), {"start": lambda self: None})
    whole = type("Whole", (Skill,), {"start": lambda self: None, "step": lambda self: True})
    context = context_of()
    assert findings(empty("e", context), context) == ["s/e: Empty has no steps(), nor start() and step()"]
    assert findings(half("h", context), context) == ["s/h: Half has start(), but no step()"]
    assert findings(whole("w", context), context) == []


def fails(context):
    raise SkillFailure(Reason.NOTHING_SEEN)


@pytest.mark.parametrize(
    ("test", "wrong"),
    [
        (lambda context: False, ""),
        (fails, ""),
        (lambda context: context.board.get("later"), ""),
        (lambda context: context.senses, ""),
        (lambda context: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda context: context.wold, "AttributeError: 'Context' object has no attribute 'wold'"),
        (lambda context: context.world.observe().gripper_opening > 0, "ValueError: The truth value of an array"),
    ],
)
def test_a_condition_is_asked_and_must_answer(test, wrong):
    context = context_of()
    found = findings(Condition("c", test), context)
    assert len(found) == bool(wrong)
    assert not wrong or f"s/c: asked on the scripted world, it makes an error: {wrong}" in found[0]


def test_a_condition_that_reads_is_not_asked_before_anything_is_written():
    context = context_of()
    assert findings(Condition("c", lambda context, length: 1 / 0, length=Key("k")), context) == []

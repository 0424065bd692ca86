"""Every tree can be shown, with a number for each node, and a viewer written by others reads it."""

import numpy as np
import py_trees
import pytest
from btview.model import NodeKind
from btview.parser import parse_bt_xml
from caretree.sim.errors import CaretreeError
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import HoldStill
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Input, Key
from caretree.skills.core.skill import Skill
from caretree.trees import Condition, Stage, Timeout, sequence
from caretree.trees.groot import shown_tree
from caretree.trees.groot.shown_tree import ShownTree
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.nodes.decorators import Stage as StageNode
from caretree.trees.run.task import load_task, task_names


def tree_of(task):
    guard = GuardedWorld(task.scripted(0)[0])
    return task.build(Context(world=guard, guard=guard))


@pytest.fixture
def context():
    guard = GuardedWorld(ScriptedWorld(seed=100))
    return Context(world=guard, guard=guard)


@pytest.mark.parametrize("name", task_names())
def test_a_viewer_written_by_others_reads_the_tree_of_every_task(name):
    root = tree_of(load_task(name))
    shown = ShownTree(root)
    read = parse_bt_xml(shown.xml)
    nodes = shown.nodes()
    assert [node.uid for node in read.walk()] == list(range(1, len(nodes) + 1))
    for node in read.walk():
        mine = nodes[node.uid]
        if node.kind is NodeKind.SUBTREE:
            assert isinstance(mine, StageNode)
            assert shown.uids[mine] == [node.uid, node.uid + 1]
        else:
            assert node.name == mine.name
            assert node.registration in read.registry
            assert {child.name for child in node.children if child.name} <= {child.name for child in mine.children}
    assert set(shown.uids) == set(root.iterate())


def test_ports_show_keys_and_constants():
    read = parse_bt_xml(ShownTree(tree_of(load_task("wave"))).xml)
    up = next(node for node in read.walk() if node.name == "hand up")
    assert up.ports == {"side": "left", "joint": "w1", "angle": "0.6", "before": "{wave_before}"}
    assert up.kind is NodeKind.ACTION


def test_what_xml_cannot_hold_is_shown_as_text(context):
    class Strange(py_trees.composites.Sequence):
        pass

    class Odd(Skill):
        what = Input(object)
        where = Input(np.ndarray, default=None)

        def steps(self):
            yield

    odd = Odd("odd", context, what={"a": 1}, where=np.zeros((2, 2)))
    Skill.registry.remove(Odd)
    lasts = Timeout("long", HoldStill("still", context), seconds=1.00001)
    ask = Condition("asked", lambda context, x: True, x=Key("x"))
    root = sequence("all", Strange("strange", True, [odd, ask]), lasts)
    read = {node.name: node for node in parse_bt_xml(ShownTree(root).xml).walk()}
    assert read["odd"].ports == {"what": "{'a': 1}", "where": "[[0. 0.] [0. 0.]]"}
    assert (read["strange"].registration, read["strange"].kind) == ("Strange", NodeKind.CONTROL)
    assert (read["asked"].registration, read["asked"].ports) == ("Condition", {"x": "{x}"})
    assert read["long"].ports == {}


def test_stages_of_one_name_are_trees_of_their_own(context):
    stages = [Stage("hold", None, HoldStill(f"still {k}", context)) for k in range(2)]
    shown = ShownTree(sequence("all", *stages))
    assert shown.boards == ["Task", "HoldStage", "HoldStage2"]
    assert [node.name for node in parse_bt_xml(shown.xml).walk()] == [
        "all", "", "hold", "still 0", "", "hold", "still 1"
    ]  # fmt: skip


def test_more_nodes_than_numbers_are_refused(context, monkeypatch):
    monkeypatch.setattr(shown_tree, "LARGEST_UID", 3)
    with pytest.raises(CaretreeError, match="cannot show more than 3 nodes"):
        ShownTree(sequence("all", *(HoldStill(str(k), context) for k in range(3))))

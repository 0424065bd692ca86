"""What is written is read as the same tree, and runs to the same trace."""

import os
import subprocess
from xml.etree import ElementTree

import py_trees
import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import HoldStill
from caretree.skills.core.context import Context
from caretree.skills.core.skill import Skill
from caretree.trees import Condition, Timeout
from caretree.trees.btcpp.document import XmlError
from caretree.trees.btcpp.values import same
from caretree.trees.btcpp.vocabulary import Vocabulary
from caretree.trees.btcpp.writer import ExportError, written
from caretree.trees.commands.export import exported
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.nodes.decorators import RecoverBy
from caretree.trees.run.runner import run
from caretree.trees.run.task import load_task, task_names
from caretree.trees.run.trace import paths_of

SEED = 100


def tree_of(task, **params):
    guard = GuardedWorld(task.scripted(0)[0])
    return task.build(Context(world=guard, guard=guard), **params)


def parts_of(root):
    """All that tells two trees apart: paths, kinds, wiring, numbers."""
    for node, path in paths_of(root).items():
        wired = {}
        if isinstance(node, (Skill, Condition)):
            wired = dict(node.bindings)
        own = [getattr(node, name, None) for name in ("attempts", "seconds", "memory", "test", "reason")]
        if isinstance(node, RecoverBy):
            own.append({reason: path_of.name for reason, path_of in node.recoveries.items()})
        yield path, type(node), wired, own


def assert_same_tree(one, other):
    ones, others = list(parts_of(one)), list(parts_of(other))
    assert [part[:2] for part in ones] == [part[:2] for part in others]
    for (path, _, wired, own), (_, _, again, same_own) in zip(ones, others, strict=True):
        assert wired.keys() == again.keys(), path
        assert all(same(wired[name], again[name]) for name in wired), path
        assert own == same_own, path


def read_again(task, tmp_path, stage=None):
    path = tmp_path / f"{task.name}.xml"
    path.write_text(exported(task, folder=tmp_path, stage=stage))
    return load_task(str(path))


@pytest.mark.no_cover  # counting lines doubles its time
@pytest.mark.parametrize(
    "name", [name if name == "wave" else pytest.param(name, marks=pytest.mark.extra) for name in task_names()]
)
def test_every_task_comes_back_as_the_same_tree_and_runs_to_the_same_trace(name, tmp_path):
    task = load_task(name)
    again = read_again(task, tmp_path)
    assert_same_tree(tree_of(task), tree_of(again))
    hashes = []
    for each in (task, again):
        world, senses = each.scripted(SEED)
        hashes.append(run(each, world, seed=SEED, senses=senses).trace_hash)
    assert hashes[0] == hashes[1]
    assert exported(again, folder=tmp_path) == exported(task, folder=tmp_path), "written again, it is the same file"


@pytest.mark.extra
@pytest.mark.parametrize("stage", load_task("dressing").stages)
def test_a_stage_alone_is_written_too(stage, tmp_path):
    task = load_task("dressing")
    again = read_again(task, tmp_path, stage)
    assert_same_tree(tree_of(task, **task.parameters(stage)), tree_of(again))


def test_a_task_of_ones_own_is_named_by_its_path(tmp_path):
    (tmp_path / "own.py").write_text("""
from caretree.skills import Skill, Retreat, Input
from caretree.trees import FailSafe

class Wait(Skill):
    seconds = Input(float, default=0.5)
    def steps(self):
        yield from self.wait(self.seconds)

def build(context):
    return FailSafe("safe", Wait("wait", context, seconds=0.25), Retreat("let go", context, ready="never"))
""")
    before = list(Skill.registry)
    task = load_task(str(tmp_path / "own.py"))
    folder = tmp_path / "trees"
    folder.mkdir()
    (folder / "own.xml").write_text(exported(task, folder=folder))
    assert '<?caretree python="../own.py"?>' in (folder / "own.xml").read_text()
    again = load_task(str(folder / "own.xml"))
    assert [node.name for node in tree_of(again).iterate()] == ["wait", "let go", "safe"]
    Skill.registry[:] = before


@pytest.mark.extra
def test_the_file_is_what_the_schema_of_behaviortree_cpp_asks_for(tmp_path):
    root = ElementTree.fromstring(exported(load_task("dressing"), folder=tmp_path))
    assert root.attrib == {"BTCPP_format": "4", "main_tree_to_execute": "Task"}
    models = {model.get("ID"): model for model in root.iterfind("TreeNodesModel/*")}
    native = {"Sequence", "Fallback", "RetryUntilSuccessful", "Timeout", "SubTree"}
    ids = [tree.get("ID") for tree in root.iterfind("BehaviorTree")]
    assert ids[0] == "Task"
    assert not set(ids) & models.keys(), "a tree may not be called as a node is"
    for tree in root.iterfind("BehaviorTree"):
        assert len(tree) == 1
        for node in tree.iterfind(".//*"):
            assert node.tag in models.keys() | native
            if node.tag in models:
                ports = {port.get("name") for port in models[node.tag]}
                assert node.attrib.keys() - {"name"} <= ports, node.tag
            if node.tag == "SubTree":
                assert node.get("ID") in ids


@pytest.mark.skipif("BTCPP_ACCEPTS" not in os.environ, reason="BTCPP_ACCEPTS names the program built from accepts.cpp")
@pytest.mark.parametrize(
    "name", [name if name == "wave" else pytest.param(name, marks=pytest.mark.extra) for name in task_names()]
)
def test_behaviortree_cpp_accepts_every_task(name, tmp_path):
    path = tmp_path / "task.xml"
    path.write_text(exported(load_task(name), folder=tmp_path))
    said = subprocess.run([os.environ["BTCPP_ACCEPTS"], str(path)], capture_output=True, text=True, timeout=60)
    assert "accepted" in said.stdout, said.stdout


ODD = """
from caretree.skills import HoldStill, Key, MoveJoint, Retreat
from caretree.trees import Condition, FailSafe, Retry, Stage, Timeout, parallel, sequence


def hands_free(context, least: float = 0.0):
    return True


CONDITIONS = (hands_free,)


def build(context):
    up = MoveJoint("up \\"<&>\\" 'ä' / 1", context, side="left", joint="w1", angle=0.1, before=Key("was"))
    both = parallel("both", up, Condition("free", hands_free, least=0.125), policy="one")
    held = Retry("again", HoldStill("h", context), attempts=2)
    body = sequence("all", Stage("first stage", hands_free, both), Stage("First stage", None, held))
    return FailSafe("safely", Timeout("in time", body, seconds=0.3), Retreat("let go", context, ready="never"))
"""


def test_names_of_any_kind_are_kept(tmp_path):
    (tmp_path / "odd.py").write_text(ODD)
    task = load_task(str(tmp_path / "odd.py"))
    again = read_again(task, tmp_path)
    assert list(paths_of(tree_of(again)).values()) == list(paths_of(tree_of(task)).values())
    assert exported(again, folder=tmp_path) == (tmp_path / "odd.xml").read_text()
    text = (tmp_path / "odd.xml").read_text()
    (tmp_path / "odd.xml").write_text(text.replace('<?caretree python="odd.py"?>', ""))
    with pytest.raises(XmlError, match=r"odd.xml:\d+: there is no node 'HandsFree'"):
        tree_of(load_task(str(tmp_path / "odd.xml")))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda c: Condition("c", lambda context: True), "'c': it asks the function '<lambda>', which XML cannot name"),
        (lambda c: Timeout("t", HoldStill("h", c), seconds=1e-4), "'t': 0.0001 s cannot be written"),
        (lambda c: type("Mine", (Skill,), {})("mine", c), "'mine': Mine is not in the task's file"),
        (lambda c: py_trees.behaviours.Running("r"), "'r': a Running cannot be written in XML"),
    ],
)
def test_what_xml_cannot_hold_is_told(make, said):
    before = list(Skill.registry)
    guard = GuardedWorld(ScriptedWorld())
    with pytest.raises(ExportError) as refused:
        written(make(Context(world=guard, guard=guard)), Vocabulary.of(), "")
    assert said in str(refused.value)
    Skill.registry[:] = before

from pathlib import Path

import pytest
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Key
from caretree.trees.btcpp.builder import Builder
from caretree.trees.btcpp.document import XmlError
from caretree.trees.btcpp.files import TreeFiles
from caretree.trees.btcpp.vocabulary import Vocabulary
from caretree.trees.guard.guard import GuardedWorld
from caretree.trees.proof.wiring import Wiring
from caretree.trees.run.shape import DEPTH_MAX
from caretree.trees.run.trace import paths_of

MOVE = '<MoveJoint name="{}" side="left" joint="w1" angle="{}"/>'


def both_hands(context, least: float = 0.0):
    return True


def least_of(context, least: float):
    return True


VOCABULARY = Vocabulary(Vocabulary.of().skills, {"BothHands": both_hands, "LeastOf": least_of})


def build(tmp_path, *trees, models="", root='BTCPP_format="4"'):
    path = tmp_path / "t.xml"
    named = "".join(f'\n<BehaviorTree ID="{chr(65 + n)}">{tree}</BehaviorTree>' for n, tree in enumerate(trees))
    main = ' main_tree_to_execute="A"' if len(trees) > 1 else ""
    path.write_text(f"<root {root}{main}>{models}{named}\n</root>")
    guard = GuardedWorld(ScriptedWorld())
    return Builder(TreeFiles(path), VOCABULARY, Context(world=guard, guard=guard)).build()


def refusal(*arguments, **options):
    with pytest.raises(XmlError) as refused:
        build(*arguments, **options)
    return str(refused.value)


def leaf(root, name):
    return next(node for node in root.iterate() if node.name == name)


def test_a_sub_tree_is_put_in_place_without_a_level_of_its_own(tmp_path):
    root = build(tmp_path, '<Sequence name="s"><SubTree ID="B"/></Sequence>', MOVE.format("up", 0.2))
    assert list(paths_of(root).values()) == ["s", "s/up"]


def test_ports_of_a_sub_tree_are_bound_to_keys_and_constants_outside(tmp_path):
    inner = '<MoveJoint name="up" side="{side}" joint="w1" angle="{angle}" before="{before}" speed="{speed}"/>'
    root = build(
        tmp_path,
        '<Sequence><SubTree ID="B" name="one" angle="{goal}" side="right" speed="{=}"/>'
        '<SubTree ID="B" name="two" angle="0.25" side="left" speed="0.5" before="{@was}"/></Sequence>',
        inner,
    )
    one, two = leaf(root, "one/up"), leaf(root, "two/up")
    assert (one.bindings["angle"], one.bindings["side"], one.bindings["speed"]) == (Key("goal"), "right", Key("speed"))
    assert (two.bindings["angle"], two.bindings["side"], two.bindings["before"]) == (0.25, "left", Key("was"))
    own = one.bindings["before"]
    assert own not in (Key("before"), two.bindings["before"]), "what is not bound is the sub-tree's own"


def test_keys_are_shared_with_autoremap_but_for_private_ones(tmp_path):
    inner = '<MoveJoint name="up" side="left" joint="w1" angle="{goal}" before="{_own}"/>'
    root = build(tmp_path, '<SubTree ID="B" _autoremap="true"/>', inner)
    assert root.bindings["angle"] == Key("goal")
    assert root.bindings["before"] != Key("_own")


def test_constants_reach_through_sub_trees_of_sub_trees(tmp_path):
    root = build(
        tmp_path,
        '<SubTree ID="B" name="b" a="0.125"/>',
        '<SubTree ID="C" name="c" a="{a}"/>',
        MOVE.format("up", "{a}"),
    )
    assert root.name == "b/c/up"
    assert root.bindings["angle"] == 0.125


def test_a_model_says_which_ports_a_sub_tree_needs_and_what_the_others_are(tmp_path):
    ports = '<input_port name="a"/><input_port name="b" default="2"/>'
    models = f'<TreeNodesModel><SubTree ID="B">{ports}</SubTree></TreeNodesModel>'
    inner = '<MoveJoint name="up" side="left" joint="w1" angle="{a}" speed="{b}"/>'
    assert "needs its port a" in refusal(tmp_path, '<SubTree ID="B"/>', inner, models=models)
    assert build(tmp_path, '<SubTree ID="B" a="1"/>', inner, models=models).bindings["speed"] == 2.0


def test_both_ways_to_write_a_node_are_read(tmp_path):
    root = build(
        tmp_path,
        '<Control ID="Sequence" name="s"><Action ID="HoldStill" name="h" _uid="3"/>'
        '<Condition ID="BothHands" least="0.5"/></Control>',
    )
    assert [type(node).__name__ for node in root.children] == ["HoldStill", "Condition"]
    assert root.children[1].bindings == {"least": 0.5}
    assert root.children[1].name == "BothHands"


@pytest.mark.parametrize(
    ("tree", "said"),
    [
        ("<LiftArms/>", "t.xml:2: there is no node 'LiftArms'; did you mean LiftArm?"),
        ("<Action/>", "t.xml:2: <Action> needs the attribute ID"),
        ('<Sequence ID="x"><HoldStill/></Sequence>', "<Sequence> has no ID"),
        ("<Repeat><HoldStill/></Repeat>", "BehaviorTree.CPP's Repeat has no counterpart here"),
        ('<HoldStill _skipIf="a == 1"/>', "_skipIf is a script"),
        ("<Sequence/>", "Sequence has 0 children, but 1 or more are asked for"),
        ('<Timeout msec="1"><HoldStill/><HoldStill/></Timeout>', "Timeout has 2 children, but 1 are asked for"),
        ("<Stage><HoldStill/><HoldStill/><HoldStill/></Stage>", "but 1 to 2 are asked for"),
        ("<HoldStill><HoldStill/></HoldStill>", "<HoldStill> is a leaf"),
        ('<HoldStill second="1"/>', "HoldStill has no port 'second'; did you mean seconds?"),
        ('<HoldStill seconds="soon"/>', "HoldStill.seconds: 'soon' is no number"),
        ('<HoldStill seconds="nan"/>', "HoldStill.seconds: 'nan' is no number"),
        ('<HoldStill seconds="{a b}"/>', "key 'a b' is not an identifier"),
        ('<MoveJoint side="left" joint="w1" angle="1" before="1"/>', "MoveJoint.before is an output and takes a {key}"),
        ("<MoveJoint/>", 'MoveJoint needs angle="...": a float, or a {key}'),
        ('<HoldStill nam="x"/>', "HoldStill has no port 'nam'; did you mean name?"),
        ("<LeastOf/>", "'LeastOf' needs least=\"...\": a float, or a {key}"),
        ('<LeastOf laest="1"/>', "'LeastOf' has no port 'laest'; did you mean least?"),
        ('<Timeout msec="{m}"><HoldStill/></Timeout>', "needs a constant there"),
        ('<Timeout mse="1"><HoldStill/></Timeout>', "Timeout has no port 'mse'; did you mean msec?"),
        ('<Timeout msec="-1"><HoldStill/></Timeout>', "seconds of 'Timeout' is -0.001"),
        ('<BothHands most="1"/>', "'BothHands' has no port 'most'; there are least, name, reason"),
        ('<BothHands reason="LATE"/>', "there is no reason 'LATE'"),
        ('<SubTree ID="B"/>', "there is no tree 'B'; there are A"),
        ('<SubTree ID="A"/>', "tree 'A' contains itself: A > A"),
        ('<Sequence><SubTree ID="A" _autoremap="maybe"/></Sequence>', "contains itself"),
    ],
)
def test_a_mistake_is_told_with_its_line_and_the_nearest_name(tmp_path, tree, said):
    assert said in refusal(tmp_path, tree)
    assert refusal(tmp_path, tree).startswith(f"{tmp_path}/t.xml:2: ")


def test_trees_that_contain_each_other_are_refused(tmp_path):
    text = refusal(tmp_path, '<SubTree ID="B"/>', '<Sequence><SubTree ID="A"/></Sequence>')
    assert "tree 'A' contains itself: A > B > A" in text


def test_trees_that_multiply_are_refused(tmp_path):
    trees = [f"<Sequence>{f'<SubTree ID={chr(34)}{chr(66 + n)}{chr(34)}/>' * 10}</Sequence>" for n in range(8)]
    assert "nodes" in refusal(tmp_path, *trees, "<HoldStill/>")


def test_trees_that_lie_too_deep_are_refused(tmp_path):
    deep = "<Inverter>" * DEPTH_MAX + "<SubTree ID='B'/>" + "</Inverter>" * DEPTH_MAX
    assert "inside each other" in refusal(tmp_path, deep, "<HoldStill/>")


def test_names_of_files_in_messages_are_those_that_were_given(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert refusal(Path(), "<LiftArms/>").startswith("t.xml:2: ")


def wired(root):
    """What `caretree check` says of the keys of a tree."""
    wiring = Wiring(paths_of(root))
    wiring.check(root)
    return wiring.findings


def test_a_misspelt_key_is_told_as_it_is_written_with_its_line_and_the_nearest(tmp_path):
    up = '<MoveJoint name="up" side="left" joint="w1" angle="0.2" before="{before}"/>'
    tree = f"""<Sequence name="s">{up}
{MOVE.format("down", "{befor}")}
<SubTree ID="B" name="part" goal="{{before}}"/></Sequence>"""
    part = f"""<Sequence name="p">{MOVE.format("there", "{goal}")}
{MOVE.format("back", "{gaol}")}</Sequence>"""
    way = "which is not written on every way to here (written by nobody"
    assert wired(build(tmp_path, tree, part)) == [
        f"s/down: input angle reads {{befor}} at {tmp_path}/t.xml:3, {way}; did you mean {{before}}?)",
        f"s/p/part/back: input angle reads {{gaol}} at {tmp_path}/t.xml:6, {way})",
    ]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ('gaol="0.2"', "t.xml:2: tree 'B' uses no key 'gaol'; did you mean goal?"),
        ('gaol="{=}" _autoremap="true"', "t.xml:2: tree 'B' uses no key 'gaol'; did you mean goal?"),
    ],
)
def test_a_key_that_a_sub_tree_does_not_use_is_told_where_it_is_put_in_place(tmp_path, given, said):
    assert said in refusal(tmp_path, f'<Sequence><SubTree ID="B" {given}/></Sequence>', MOVE.format("up", "{goal}"))


def test_a_sub_tree_may_be_given_what_those_below_it_share_or_its_model_names(tmp_path):
    shared = '<Sequence><SubTree ID="C" _autoremap="true"/></Sequence>'
    build(tmp_path, '<Sequence><SubTree ID="B" goal="0.2"/></Sequence>', shared, MOVE.format("up", "{goal}"))
    models = '<TreeNodesModel><SubTree ID="B"><input_port name="speed"/></SubTree></TreeNodesModel>'
    build(tmp_path, '<Sequence><SubTree ID="B" speed="1"/></Sequence>', MOVE.format("up", 0.2), models=models)
    unshared = '<Sequence><SubTree ID="C" goal="0.2"/></Sequence>'
    said = refusal(tmp_path, '<Sequence><SubTree ID="B" goal="1"/></Sequence>', unshared, MOVE.format("up", "{goal}"))
    assert "tree 'B' uses no key 'goal'; it uses none" in said

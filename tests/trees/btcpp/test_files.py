import pytest
from caretree.trees.btcpp.document import XmlError
from caretree.trees.btcpp.files import FILES_MAX, TreeFiles

LEAF = "<HoldStill/>"


def write(path, body, attributes='BTCPP_format="4"'):
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"<root {attributes}>\n{body}\n</root>")
    return path


def tree(name, body=LEAF):
    return f'<BehaviorTree ID="{name}">{body}</BehaviorTree>'


def test_includes_are_found_from_the_file_that_names_them(tmp_path):
    write(tmp_path / "sub/b.xml", f'<include path="c.xml"/>{tree("B")}')
    (tmp_path / "sub/c.xml").write_text(f'<?caretree python="d.py"?><root BTCPP_format="4">{tree("C")}</root>')
    files = TreeFiles(
        write(
            tmp_path / "a.xml",
            f'<include path="sub/b.xml"/>{tree("A")}',
            'BTCPP_format="4" main_tree_to_execute="A"',
        )
    )
    assert (files.main, sorted(files.trees)) == ("A", ["A", "B", "C"])
    assert [(each.name, each.file, each.line) for each in files.python] == [("d.py", tmp_path / "sub/c.xml", 1)]
    with pytest.raises(XmlError, match=r"sub/c.xml:1: 'd.py' is neither a task of the package nor a .py file"):
        files.python[0].path()
    (tmp_path / "sub/d.py").touch()
    assert files.python[0].path() == tmp_path / "sub/d.py"


def test_files_that_include_each_other_are_read_once(tmp_path):
    write(tmp_path / "b.xml", '<include path="a.xml"/>')
    assert TreeFiles(write(tmp_path / "a.xml", f'<include path="b.xml"/>{tree("A")}')).main == "A"


def test_a_lone_tree_needs_no_name(tmp_path):
    assert TreeFiles(write(tmp_path / "a.xml", f"<BehaviorTree>{LEAF}</BehaviorTree>")).main == "BehaviorTree"


@pytest.mark.parametrize(
    ("body", "attributes", "said"),
    [
        (tree("A"), "", 'a.xml:1: <root> needs BTCPP_format="4"'),
        (tree("A"), 'BTCPP_format="3"', 'needs BTCPP_format="4"'),
        (tree("A"), 'BTCPP_format="4" main_tree_to_execute="a"', "no tree is called so; there are A"),
        (tree("A") + tree("B"), 'BTCPP_format="4"', "2 trees are here: say with main_tree_to_execute"),
        ("", 'BTCPP_format="4"', "0 trees are here"),
        (tree("A") + tree("A"), 'BTCPP_format="4"', "a.xml:2: there is a tree 'A' already, at"),
        (tree("A", LEAF * 2), 'BTCPP_format="4"', "a.xml:2: tree 'A' has 2 nodes at its root"),
        ("<Behaviortree/>", 'BTCPP_format="4"', "did you mean BehaviorTree?"),
        ('<include path="no.xml"/>', 'BTCPP_format="4"', "no.xml does not exist"),
        ("<include/>", 'BTCPP_format="4"', "<include> needs the attribute path"),
        ('<include ros_pkg="a" path="b"/>', 'BTCPP_format="4"', "ros_pkg is not known here"),
    ],
)
def test_a_mistake_is_told_with_its_line(tmp_path, body, attributes, said):
    with pytest.raises(XmlError) as refused:
        TreeFiles(write(tmp_path / "a.xml", body, attributes))
    assert said in str(refused.value)


def test_a_chain_of_includes_has_an_end(tmp_path):
    for n in range(FILES_MAX + 1):
        write(tmp_path / f"{n}.xml", f'<include path="{n + 1}.xml"/>')
    with pytest.raises(XmlError, match=f"more than {FILES_MAX} files"):
        TreeFiles(tmp_path / "0.xml")

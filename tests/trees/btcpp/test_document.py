import pytest
from caretree.trees.btcpp.document import DEPTH_MAX, SIZE_MAX, XmlError, nearest, read_document


def read(tmp_path, text):
    path = tmp_path / "t.xml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_document(path)


def test_elements_know_their_lines_and_attributes(tmp_path):
    document = read(tmp_path, '<?caretree python="wave"?>\n<root a="1">\n  <b c="&lt;2&gt;">text</b>\n  <d/>\n</root>')
    assert document.python == [("wave", 1)]
    assert [(e.tag, e.line, e.attributes) for e in document.root.children] == [("b", 3, {"c": "<2>"}), ("d", 4, {})]
    assert document.root.below("d") == [document.root.children[1]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "t.xml:1: no element found"),
        ("<root>\n<a>\n</root>", "t.xml:3: mismatched tag"),
        ("<tree/>", "but this is <tree>"),
        ('<root a="1" a="2"/>', "t.xml:1: duplicate attribute"),
        ("<root>\n&nbsp;</root>", "t.xml:2: undefined entity"),
        (b"<root>\xff</root>", "t.xml:1: not well-formed"),
        ("<?xml version='1.0' encoding='klingon'?><root/>", "t.xml:1: "),
        (
            '<?xml version="1.0"?>\n<!DOCTYPE root [<!ENTITY a "aaa">]><root>&a;</root>',
            "t.xml:2: a tree has no <!DOCTYPE>",
        ),
        ('<!DOCTYPE root SYSTEM "file:///etc/passwd"><root/>', "t.xml:1: a tree has no <!DOCTYPE>"),
        ("<?caretree wave?><root/>", 'is not written <?caretree python="..."?>'),
        ("<root>" + "<a>" * DEPTH_MAX + "</a>" * DEPTH_MAX + "</root>", f"at most {DEPTH_MAX} are read"),
        (b" " * (SIZE_MAX + 1), "bytes are no tree"),
    ],
)
def test_what_is_no_tree_is_refused_with_its_line(tmp_path, text, said):
    with pytest.raises(XmlError) as refused:
        read(tmp_path, text)
    assert said in str(refused.value)


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(XmlError, match="Is a directory"):
        read_document(tmp_path)


def test_the_nearest_name_is_offered():
    assert nearest("LiftArms", ["LiftArm", "Spread"]) == "did you mean LiftArm?"
    assert nearest("zzz", ["b", "a"]) == "there are a, b"
    assert nearest("zzz", map(str, range(100))).startswith("among others there are ")

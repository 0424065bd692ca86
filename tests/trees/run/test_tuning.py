import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.run.tuning import read_given


def test_values_are_read_as_yaml_and_later_ones_win(tmp_path):
    path = tmp_path / "slow.yaml"
    path.write_text("present_sleeve:\n  max_load: 2.0\n  speed: 0.1\nseconds: 8\narm: right\n")
    given = read_given(["present_sleeve.max_load=3.5", "lay_gown.shares=[1.0, 0.5]", "arm=left"], str(path))
    assert given.settings.values == {
        "present_sleeve": {"max_load": 3.5, "speed": 0.1},
        "lay_gown": {"shares": [1.0, 0.5]},
    }
    assert given.parameters == {"arm": "left", "seconds": 8}


@pytest.mark.parametrize("text", ["=3.5", "present_sleeve.max_load", "present_sleeve.=3", ".a=3", "a.b="])
def test_an_assignment_of_another_form_is_refused(text):
    with pytest.raises(CaretreeError, match="parameter of the task is asked for"):
        read_given([text])


@pytest.mark.parametrize(
    ("content", "words"),
    [("- 1\n", "maps skills to numbers"), ("a: [3]\n", "maps skills"), ("a: [\n", r"slow.yaml:2"), ("", "maps skills")],
)
def test_a_file_of_another_form_is_refused(tmp_path, content, words):
    path = tmp_path / "slow.yaml"
    path.write_text(content)
    with pytest.raises(CaretreeError, match=words):
        read_given([], str(path))


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(CaretreeError, match=r"none\.yaml cannot be read"):
        read_given([], str(tmp_path / "none.yaml"))

import pytest
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.joints.robot_files import find_urdf, robots_folder

pytest.importorskip("pinocchio")
NAMES = sorted({p.stem for p in robots_folder().rglob("*.urdf")} | {p.name for p in robots_folder().iterdir()})


@pytest.mark.parametrize("name", NAMES)
def test_every_name_of_example_robot_data_is_a_file_with_a_robot_or_says_why(name, tmp_path):
    if name == "cassie_description":  # comes as SDF alone
        with pytest.raises(GapError, match="has no URDF of it"):
            find_urdf(name, tmp_path)
        return
    for spelt in (name, name.lower(), name.removesuffix("_description")):
        assert "<link" in find_urdf(spelt, tmp_path).read_text()


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("ur3", "ur3_robot.urdf"),
        ("ur10", "ur10_robot.urdf"),
        ("panda", "panda.urdf"),
        ("twodofs", "TwoDofs.urdf"),
        ("anymal_c_simple", "anymal.urdf"),
        ("so_arm", "so100.urdf"),
    ],
)
def test_short_names_mean_the_plain_robot(name, file, tmp_path):
    found = find_urdf(name, tmp_path)
    assert found.name == file
    assert name != "anymal_c_simple" or "anymal_c" in str(found)


def test_a_file_beside_the_set_comes_first(tmp_path):
    (tmp_path / "own.urdf").write_text("<robot name='own'/>")
    assert find_urdf("own.urdf", tmp_path) == tmp_path / "own.urdf"
    with pytest.raises(GapError, match="no URDF file gone"):
        find_urdf("gone.urdf", tmp_path)


def test_an_unknown_robot_is_told_with_names_that_exist(tmp_path):
    with pytest.raises(GapError, match="robot is 'r2d2', it must be a URDF file or a name in example-robot-data"):
        find_urdf("r2d2", tmp_path)
